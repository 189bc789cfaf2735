// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/adapt/adapter_options.h"
#include "retarget/adapt/kernel/adapt_load.h"
#include "retarget/adapt/kernel/adapt_solve.h"
#include "retarget/adapt/kernel/lane_result.h"
#include "retarget/adapt/kernel/thesis_solve.h"
#include "retarget/adapt/plan/adapt_numbers.h"
#include "retarget/constraints/activation.h"

namespace marey::retarget {

/// Inputs of one solve in packed form: all numbers of a lane except the body's own.
/// Bodies with the same plan may use one instance in turn, so that it stays in the L1
/// cache.
struct PackedProblem {
  const Plan* plan = nullptr;  ///< Not owned: the body's own plan or an equal one.
  std::vector<float> posture;
  std::vector<float> targets;
  std::array<float, kBalanceNumbers> balance{};
  std::vector<TargetNumbers> numbers;  ///< In the order of plan.points; `targets` are
                                       ///< computed from them.
  std::vector<double> activations;     ///< In the order of plan.points.
  double max_weight = 0.0;             ///< Largest weight of the active constraints.
  std::vector<double> ramps;           ///< Distinct activations below 1, descending.
  explicit PackedProblem(const Plan& shared);
};

/// Normalizes to double precision: one Newton step from single precision, without a
/// square root.
[[nodiscard]] inline glm::dquat unit_rotation(double w, double x, double y, double z) {
  const double s = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
  return {s * w, s * x, s * y, s * z};
}

/// State of an adapter between postures, with one lane for its solves. A member of a
/// crowd uses it to pack its inputs, and to solve postures with fading constraints.
struct AdapterState {
  Character character;
  ConstraintSet constraints;
  AdaptOptions options;
  BodyNumbers body;
  std::vector<glm::dquat> t_pose_from_joint;
  std::vector<char> carried;  ///< Per load.
  std::optional<glm::dvec3> com_in_world;
  bool is_member = false;  ///< Member of a crowd: plan and options are fixed.

  // Origin of the current posture.
  glm::dvec3 origin_in_world{0.0};
  std::vector<LiveActivation> live;      ///< Per constraint.
  Control control = Control::kPriority;  ///< Used by the current solve.
  /// The control that is fading out, and its current share.
  Control left_control = Control::kPriority;
  double left_share = 0.0;
  /// Fraction of the fade's duration completed at the last posture, 0 to 1, and the
  /// (extrapolated) start time of the fade; known from the next posture on.
  double passed = 1.0;
  std::optional<double> passes_since_s;
  bool is_standing = false;  ///< True while `lanes` contains the reference.
  std::vector<ConstraintOutcome> outcomes;  ///< One per constraint.
  /// Positions of supports without a footprint, recorded when they begin.
  std::vector<std::optional<glm::dvec3>> begun_in_world;
  std::vector<std::optional<glm::dquat>> begun_rotation;
  std::vector<RigidTransform> world_from_joint;

  AdapterState(const Character& character_in,
               const ConstraintSet& constraints_in,
               const AdaptOptions& options_in);

  /// Called before `to` becomes the options. Starts a fade to the other control, or
  /// reverses the running fade from the blend of the last posture.
  void turn_passage(const AdaptOptions& to);
  /// Rebuilds the plan after its inputs changed. Allocates.
  void set_up();
  AdaptReport adapt(const Pose& reference, double time_s, Pose& out);
  /// Packs all inputs of a solve. Returns false if constraints fade, so that several
  /// solves are needed. Repeatable: the same inputs give the same result.
  [[nodiscard]] bool prepare(const Pose& reference,
                             double time_s,
                             PackedProblem& problem);
  /// Prefetches the memory that prepare() and write() need: prefetch_state() the members
  /// that hold the addresses, prefetch_numbers() the memory at these addresses. Changes
  /// nothing.
  void prefetch_state() const;
  void prefetch_numbers() const;
  static void prefetch_pose(const Pose& pose);
  /// Writes the packed result of a solve (store_result()) into `out` and into the
  /// adapter's outcomes and report.
  void write(const Plan& shared, const float* numbers, Pose& out);
  [[nodiscard]] Shape shape() const;
  [[nodiscard]] SolveSettings settings() const;

  AdaptReport report;

  // Plan of the adapter's own solves; placed after the members that a crowd uses.
  Plan plan;
  PackedProblem own_problem;
  Lanes<float> lanes;
  Solve<float> solve;
  ThesisShape thesis;
  std::vector<Quat<float>> mixed_rotation;  ///< Blended results while constraints fade in
                                            ///< or out.
  Vec3<float> mixed_root;
  Vec3<float> mixed_com;
  Vec3<float> mixed_com_target;
  std::vector<Vec3<float>> mixed_left;  ///< Per target: vector from the point to the
                                        ///< target.
  std::vector<float> firmness;          ///< Per target: fraction of the distance to
                                        ///< close, 0 to 1.
  std::vector<float> mixed_beyond;      ///< Angle of a joint beyond its limits. [rad]

 private:
  void read_targets(double time_s, PackedProblem& problem);
  void read_target(std::size_t k, double activation, PackedProblem& problem);
  /// Stores the position of a support in the reference when it begins, until it ends.
  void follow_support(std::size_t constraint,
                      int joint,
                      const PackedProblem& problem,
                      const TargetNumbers& target);
  [[nodiscard]] BalanceNumbers balance() const;
  void stand(const PackedProblem& problem);
  void pack_problem(double min_activation, PackedProblem& problem) const;
  /// Solves for the targets with an activation of at least `min_activation`, and
  /// accumulates figures.
  void solve_for(double min_activation, LaneFigures<float>& figures);
  void solve_faded(LaneFigures<float>& figures);
  /// Adds the solved posture, weighted by `share`, to the blended posture.
  void mix(float share);
  void take_mean();
  void close_mean();
  void aim_at_mean();
  void settle_mean();
  void pass_over(double time_s);
  /// Computes outcomes and report from the errors of the plan's points.
  void update_report(const Plan& shared, const float* errors);

  std::vector<float> result;
};

}  // namespace marey::retarget
