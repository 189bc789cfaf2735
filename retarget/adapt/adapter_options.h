// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::retarget {

/// Algorithm that computes the posture.
enum class Method {
  /// Solves limbs analytically where they suffice. Otherwise solves the whole body by
  /// damped Gauss-Newton steps in dual form. Supports have priority over the centre of
  /// mass, and the centre of mass over constraints.
  kStrict,
  /// Kulpa 2005, chapters 4 and 5: cyclic descent by groups with analytic limbs, merged
  /// with the kinetic loop ("push-pull").
  kThesis,
};

/// Meaning of the importance of constraints.
enum class Control {
  /// Strict priority by importance. Adding a less important constraint increases the
  /// error of a more important one by at most 1 mm: beyond its precision if it was met,
  /// beyond its previous error if it was not. With balance the limit is 3 % of the error
  /// if that is more, because masses are summed in another order.
  kPriority,
  kBlend,  ///< Weighted compromise.
};

/// Target of the centre of mass: CnMode of the thesis.
enum class BalanceMode {
  kOff,
  kHorizontal,  ///< Vertically above the target: quasi-static balance.
  k3d,          ///< At the target: flight.
  /// Above the targets of AdaptMotionOptions::com_in_world, which keep the zero moment
  /// point inside the support area. For whole motions; Adapter::make() refuses it.
  kZmp,
};

struct AdaptOptions {
  Method method = Method::kStrict;
  Control control = Control::kPriority;
  /// Duration of the fade when set_options() changes `control`. 0: immediate.
  double control_change_s = 0.0;
  BalanceMode balance = BalanceMode::kOff;
  /// Share of the root's translation used for constraints (CmRoot) and for balance
  /// (CnRoot), 0 to 1.
  double root_for_constraints = 1.0;
  double root_for_balance = 1.0;
  /// The solver stops when the weighted mean error of the constraints changes by less
  /// than this (CmThreshold). The strict method compares over several consecutive steps.
  double constraint_threshold_m = 1e-4;
  /// The thesis' method also requires that the error of the centre of mass changes by
  /// less than this (CnThreshold).
  double balance_threshold_m = 1e-5;
  double balance_precision_m = 1e-4;  ///< CnErrorMax: smaller errors are not corrected.
  /// Limit per try. With kPriority the strict method makes one try for each set of levels
  /// that it attempts to meet together, and one for each level that was left out. A blend
  /// and the thesis' method make one try. The first kFirstSteps steps of a strict try
  /// (kFirstStepsBalanced with balance) count, but are always completed, so smaller
  /// limits have the same effect as that number, and a try may exceed the limit by that
  /// number. The final restoration of balance does not count.
  int max_iterations = 50;
  /// If true, unconstrained hands and feet keep their world orientation (as in the
  /// thesis) instead of following forearm and shank.
  bool extremities_keep_orientation = false;
};

/// Fixed number of initial steps of a strict whole-body solve. Intermediate postures
/// during the return towards the reference are not valid results.
inline constexpr int kFirstSteps = 4;
/// The same number with balance: fewer steps with a gentler end, because the centre of
/// mass must be met as well.
inline constexpr int kFirstStepsBalanced = 3;

/// Activation above which a fading constraint is closed, completely at 1, so that it is
/// met when it becomes fully active. At or below this activation the posture is still
/// moving towards the target, and the distance is not reported as an error.
inline constexpr double kFirmActivation = 0.8;

/// Result of one constraint. At or below kFirmActivation it has no errors and is not met.
struct ConstraintOutcome {
  double activation = 0.0;  ///< 0 to 1.
  double error_m = 0.0;  ///< Distance from the point to its target; 0 for an orientation.
  double error_rad = 0.0;  ///< Remaining angle; 0 for all goals except orientations.
  bool met = false;        ///< Within the precision: is_met() in
                           ///< retarget/constraints/measure_constraint.h.
};

/// Errors are defined in the same way for both methods and all controls. They cover
/// constraints with an activation above kFirmActivation.
struct AdaptReport {
  /// Iterations of the whole-body loop, summed over all tries and all solves during
  /// fades. 0: limbs sufficed (thesis' method: no correction was necessary).
  int iterations = 0;
  /// True if max_iterations ended a try before convergence; a higher limit may improve
  /// the result.
  bool capped = false;
  /// Mean weighted by importance (eq. 4.2), without supports and orientations.
  double constraint_error_m = 0;
  double worst_error_m = 0;    ///< Over all constraints except orientations, supports
                               ///< included.
  double worst_error_rad = 0;  ///< Over orientations.
  double balance_error_m = 0;  ///< Error of the centre of mass as defined by `balance`.
};

}  // namespace marey::retarget
