// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/result.h"
#include "core/transform.h"

namespace marey::retarget {

/// Which algorithm looks for the posture.
enum class Method {
  /// Limbs analytically while they suffice, the whole body by damped Gauss-Newton steps
  /// in dual form as they do not; supports above the centre of mass above constraints.
  kStrict,
  /// Kulpa 2005, chapters 4 and 5: cyclic descent by groups, with analytic limbs, merged
  /// with the kinetic loop ("push-pull").
  kThesis,
};

/// What the importance of constraints means.
enum class Control {
  /// The more important first. A less important one that is added costs one that was met
  /// no more than 1 mm beyond its precision, and one that was missed 1 mm more; with
  /// balance, where rounding adds up masses in another order, 3 % more if that is more.
  kPriority,
  kBlend,  ///< A weighted compromise.
};

/// Where the centre of mass is wanted: CnMode of the thesis.
enum class BalanceMode {
  kOff,
  kHorizontal,  ///< Above the wanted place: quasi-static balance.
  k3d,          ///< At the wanted place: flight.
};

struct AdaptOptions {
  Method method = Method::kStrict;
  Control control = Control::kPriority;
  /// How long answers pass over when set_options() changes `control`. 0: at once.
  double control_change_s = 0.0;
  BalanceMode balance = BalanceMode::kOff;
  /// Share of its travel that the root is willing to spend on constraints (CmRoot) and on
  /// balance (CnRoot), 0 to 1.
  double root_for_constraints = 1.0;
  double root_for_balance = 1.0;
  /// Stop when the weighted mean error of the constraints changes by less (CmThreshold;
  /// the strict method: when steps in a row bring less),
  double constraint_threshold_m = 1e-4;
  /// and that of the centre of mass by less (CnThreshold; the thesis' method alone).
  double balance_threshold_m = 1e-5;
  double balance_precision_m = 1e-4;  ///< CnErrorMax: nearer is good enough.
  /// Of one try. By priority the strict method makes one for each set of levels that it
  /// tries to meet at once, and then one for each level that was left out; a blend, and
  /// the thesis' method, make one. The strict method's first kFirstSteps (with balance
  /// kFirstStepsBalanced) of a try count, but are never cut short: less than that is the
  /// same as that, and a try may end that many beyond. What brings balance back at the
  /// very end does not count.
  int max_iterations = 50;
  /// Hands and feet that are not constrained keep their orientation in the world (the
  /// thesis) instead of following forearm and shank.
  bool extremities_keep_orientation = false;
};

/// Steps that a strict solve of the whole body begins with, always as many: a posture on
/// its way back towards the reference is nobody's answer.
inline constexpr int kFirstSteps = 4;
/// With balance fewer, that end more gently: the centre of mass has to be met, too.
inline constexpr int kFirstStepsBalanced = 3;

/// A constraint that fades is closed on from this activation up, wholly at 1: so it is
/// met as it becomes fully active. At or below this the posture is on its way to it, and
/// what is missing yet is no error.
inline constexpr double kFirmActivation = 0.8;

/// What became of one constraint. At or below kFirmActivation it has no errors, and is
/// not met.
struct ConstraintOutcome {
  double activation = 0.0;  ///< 0 to 1.
  double error_m = 0.0;     ///< From its point to its target; of an orientation 0.
  double error_rad = 0.0;   ///< What is left to turn; of all but orientations 0.
  bool met = false;  ///< By its precision: is_met() in retarget/measure_constraint.h.
};

/// Errors mean the same by both methods and all controls; of constraints above
/// kFirmActivation.
struct AdaptReport {
  /// Of the whole-body loop, of all tries, and of all solves while constraints fade. 0:
  /// limbs sufficed (the thesis' method: nothing had to be done).
  int iterations = 0;
  /// max_iterations ended a try that would have gone on: with more the answer may be
  /// better.
  bool capped = false;
  /// Mean by importance (eq. 4.2): of what is no support and no orientation.
  double constraint_error_m = 0;
  double worst_error_m = 0;    ///< Of all but orientations, supports included.
  double worst_error_rad = 0;  ///< Of orientations.
  double balance_error_m = 0;  ///< Of the centre of mass, as `balance` measures it.
};

/// Adapts postures of one character to constraints that may move while it runs.
///
///     auto adapter = Adapter::make(character, constraints, {});
///     adapter->constraint("ctrParade")->set_target(ankle_in_world);
///     adapter->adapt(reference, time_s, posture);
///
/// Every posture is adapted from its own reference alone: same reference, constraints and
/// time, same answer, to the bit. (A support without a footprint is the exception: it
/// stands where the reference had it when it began.) Costs and accuracy:
/// docs/measurements.md. Nothing is allocated after make(), unless a function says so.
class Adapter {
  struct State;

 public:
  /// One constraint of a running adapter. Valid as long as the adapter.
  class Handle {
   public:
    /// The place that a DistanceToPoint keeps its distance from, or a support's
    /// footprint. Should move continuously: so does then the posture. Precondition:
    /// finite, and the goal has such a place.
    void set_target(const glm::dvec3& p_in_world);
    /// Precondition: a SegmentOrientation or Support; unit.
    void set_orientation(const glm::dquat& world_from_t_pose);
    /// Precondition: an AllowedSpace or ForbiddenSpace; finite, min <= max.
    void set_space(const glm::dvec3& min_in_world, const glm::dvec3& max_in_world);
    /// Moves the constrained point on its segment; onto or off its joint's own place is
    /// costly, allocates, and is not for a crowd's member. Precondition: finite.
    void set_offset(const glm::dvec3& offset_in_t_pose);
    /// Fades the constraint in or out from `time_s` on, over its own durations.
    void start(double time_s);
    void stop(double time_s);
    [[nodiscard]] const ConstraintOutcome& outcome() const;  ///< Of the last adapt().

   private:
    friend class Adapter;
    Handle(State& state, std::size_t constraint)
        : state_(&state), constraint_(constraint) {}
    State* state_;
    std::size_t constraint_;
  };

  /// Errors (bad input, naming the element): whatever check_character() and
  /// check_constraints() refuse; options out of range.
  [[nodiscard]] static Result<Adapter> make(const Character& character,
                                            const ConstraintSet& constraints,
                                            const AdaptOptions& options);
  Adapter(Adapter&&) noexcept;
  Adapter& operator=(Adapter&&) noexcept;
  ~Adapter();

  /// nullopt: there is no constraint of this id.
  [[nodiscard]] std::optional<Handle> constraint(std::string_view id);

  /// Where the centre of mass is wanted; nullopt: where the reference posture has that of
  /// the body alone, without loads.
  void set_balance_target(const std::optional<glm::dvec3>& com_in_world);
  /// Takes a load of the character's up, or puts it down; none is carried at first.
  /// False: it has none of that name.
  bool carry(std::string_view load, bool carried);
  /// May change from one posture to the next; a change of `control` begins with the next
  /// posture's time and fades over. One that is taken back before it is over goes back
  /// from where the last posture was. Switching balance on or off allocates.
  /// Precondition: in range; not of a crowd's member.
  void set_options(const AdaptOptions& options);

  /// Precondition: `reference` is a posture of the character's skeleton, finite, with
  /// unit rotations; `out` has room for as many joints (it is resized once).
  AdaptReport adapt(const Pose& reference, double time_s, Pose& out);

  /// Joints in the world after the last adapt(), one per joint.
  [[nodiscard]] std::span<const RigidTransform> world_from_joint() const;
  /// Of the last adapt()'s posture, whatever `balance` is, with what is carried now.
  /// Linear in the masses. Precondition: adapt() was called. [m]
  [[nodiscard]] glm::dvec3 centre_of_mass_in_world() const;

 private:
  friend class Crowd;
  explicit Adapter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::retarget
