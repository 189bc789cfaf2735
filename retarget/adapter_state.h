// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "retarget/activation.h"
#include "retarget/adapt_load.h"
#include "retarget/adapt_numbers.h"
#include "retarget/adapt_solve.h"
#include "retarget/adapter.h"
#include "retarget/lane_result.h"
#include "retarget/thesis_solve.h"

namespace marey::retarget {

/// What is asked of a body at one moment, packed: what goes into a lane beside the body's
/// own numbers. Bodies of one plan may share one, one after the other, so that it stays
/// in the nearest cache.
struct PackedQuestion {
  const Plan* plan = nullptr;  ///< Somebody else's; the body's own or an equal one.
  std::vector<float> posture;
  std::vector<float> wishes;
  std::array<float, kBalanceNumbers> balance{};
  std::vector<WishNumbers> numbers;  ///< As plan.points; `wishes` are made from them.
  std::vector<double> activations;   ///< Likewise.
  double largest_weight = 0.0;       ///< Of active constraints.
  std::vector<double> ramps;         ///< Different activations below 1, descending.
  explicit PackedQuestion(const Plan& shared);
};

/// Unit to double precision: one Newton step from single precision's, without a root.
[[nodiscard]] inline glm::dquat unit_rotation(double w, double x, double y, double z) {
  const double s = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
  return {s * w, s * x, s * y, s * z};
}

/// An adapter from one posture to the next, and one lane to solve it in. A member of a
/// crowd is one, too: it packs its questions, and solves those that fade.
struct Adapter::State {
  Character character;
  ConstraintSet constraints;
  AdaptOptions options;
  BodyNumbers body;
  std::vector<glm::dquat> t_pose_from_joint;
  std::vector<char> carried;  ///< Of each load.
  std::optional<glm::dvec3> com_in_world;
  bool is_member = false;  ///< Of a crowd: its plan and its options stay as they are.

  // Of one posture.
  glm::dvec3 origin_in_world{0.0};
  std::vector<LiveActivation> live;      ///< Of each constraint.
  Control control = Control::kPriority;  ///< Solved for at this moment.
  /// The control that is being left, and its share now.
  Control left_control = Control::kPriority;
  double left_share = 0.0;
  /// How much of the passage's duration the last posture had behind it, 0 to 1, and when
  /// it began, or would have at this pace; known from the next posture on.
  double passed = 1.0;
  std::optional<double> passes_since_s;
  bool is_standing = false;                 ///< The reference is in `lanes`.
  std::vector<ConstraintOutcome> outcomes;  ///< As the constraints.
  /// Where supports without a footprint stand, since they began.
  std::vector<std::optional<glm::dvec3>> begun_in_world;
  std::vector<std::optional<glm::dquat>> begun_rotation;
  std::vector<RigidTransform> world_from_joint;

  State(const Character& character_in,
        const ConstraintSet& constraints_in,
        const AdaptOptions& options_in);

  /// Before `to` become the options: a passage to the other control begins, or the one
  /// that runs turns back from where the last posture was.
  void turn_passage(const AdaptOptions& to);
  /// Plans anew, after what the plan is made from has changed. Allocates.
  void set_up();
  AdaptReport adapt(const Pose& reference, double time_s, Pose& out);
  /// Packs all that a solve needs. False: constraints fade, and more solves than one are
  /// needed. Again with the same, the same.
  [[nodiscard]] bool prepare(const Pose& reference, double time_s, PackedQuestion& asked);
  /// Calls for the memory that prepare() and write() need, so that it is near when they
  /// do. First for what says where the rest is, then for the rest. Changes nothing.
  void call_for_state() const;
  void call_for_numbers() const;
  static void call_for_pose(const Pose& pose);
  /// The answer out of packed numbers (store_result()): into `out`, and what the adapter
  /// tells.
  void write(const Plan& shared, const float* numbers, Pose& out);
  [[nodiscard]] Shape shape() const;
  [[nodiscard]] SolveSettings settings() const;

  AdaptReport report;

  // For solves by itself: behind what a crowd needs.
  Plan plan;
  PackedQuestion question;
  Lanes<float> lanes;
  Solve<float> solve;
  ThesisShape thesis;
  std::vector<Quat<float>> mixed_rotation;  ///< While constraints fade in or out.
  Vec3<float> mixed_root;
  Vec3<float> mixed_com;
  Vec3<float> mixed_com_target;
  std::vector<Vec3<float>> mixed_left;  ///< Of each wish, to its target.
  std::vector<float> firmness;          ///< Of each wish, how far it is closed: 0 to 1.
  std::vector<float> mixed_beyond;  ///< By how much a joint is beyond its limits. [rad]

 private:
  void read_wishes(double time_s, PackedQuestion& asked);
  void read_wish(std::size_t k, double activation, PackedQuestion& asked);
  /// Remembers where the reference has a support as it begins, until it ends.
  void follow_support(std::size_t constraint,
                      int joint,
                      const PackedQuestion& asked,
                      const WishNumbers& wish);
  [[nodiscard]] BalanceNumbers balance() const;
  void stand(const PackedQuestion& asked);
  void ask_for(double least, PackedQuestion& asked) const;
  /// Solves for the wishes whose activation is at least `least`, and adds up.
  void solve_for(double least, LaneFigures<float>& figures);
  void solve_faded(LaneFigures<float>& figures);
  /// Adds `share` of the posture that was just solved to the mixed one.
  void mix(float share);
  void take_mean();
  void close_mean();
  void aim_at_mean();
  void settle_mean();
  void pass_over(double time_s);
  /// Outcomes and report, from the errors of the plan's points.
  void judge(const Plan& shared, const float* errors);

  std::vector<float> result;
};

}  // namespace marey::retarget
