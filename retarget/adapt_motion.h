// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "core/ids.h"
#include "core/motion.h"
#include "core/progress.h"
#include "core/result.h"
#include "retarget/adapter.h"
#include "retarget/plan_supports.h"

namespace marey::retarget {

struct AdaptMotionOptions {
  AdaptOptions adapt;
  /// Loads of the character that it carries from the beginning on; it has no others. The
  /// centre of mass, load included, is wanted where the motion has the body's own, or
  /// where the supports have taken that (Adapter::set_balance_target()).
  std::vector<std::string> carried;
};

/// How well one constraint was kept, in frames in which it is fully active.
struct KeptConstraint {
  std::string id;
  bool is_support = false;
  int active_frames = 0;
  bool is_orientation = false;  ///< Its errors are angles, the lengths 0; else not.
  int met_frames = 0;           ///< is_met() in retarget/measure_constraint.h.
  double mean_error_m = 0.0;
  double worst_error_m = 0.0;
  double mean_error_rad = 0.0;
  double worst_error_rad = 0.0;
  int worst_frame = -1;  ///< Of the motion's poses; -1 when it never was fully active.
  /// max_iterations ended a solve of a frame in which it was not met.
  bool ran_out = false;
};

/// The hardest jerk that adaptation put into a motion: the greatest acceleration of a
/// joint's way from where the motion has it. Fading over T seconds over a way of s metres
/// takes 5.8 s / T^2; much more than that is a posture that jumped.
struct AddedAcceleration {
  double m_per_s2 = 0.0;
  JointIndex joint{};
  int frame = 0;  ///< Of the motion's poses.
};

struct AdaptedMotion {
  Motion motion;
  std::vector<KeptConstraint> constraints;  ///< As the set's, supports of it included.
  std::vector<KeptConstraint> supports;     ///< As the tracks.
  double mean_iterations = 0.0;
  int most_iterations = 0;
  int capped_frames = 0;  ///< AdaptReport::capped.
  double mean_balance_error_m = 0.0;
  double worst_balance_error_m = 0.0;
  int worst_balance_frame = 0;  ///< Of the motion's poses.
  AddedAcceleration added;
};

/// Adapts every posture of a motion (Kulpa 2005, 4 and 5) to constraints and to the
/// supports of its feet. Frame, rate and names are the motion's; frame i is at time
/// (first_frame + i) / rate. Same input, same bytes. Errors are measured by forward
/// kinematics on the answer (retarget/measure_constraint.h). Costs one Adapter::adapt()
/// a frame.
///
/// Errors (bad input): Adapter::make()'s; a load that the character does not have.
/// Precondition: the motion is of the character's skeleton; the rate is positive; tracks
/// have its frames.
[[nodiscard]] Result<AdaptedMotion> adapt_motion(const Motion& motion,
                                                 const Character& character,
                                                 const ConstraintSet& constraints,
                                                 std::span<const SupportTrack> supports,
                                                 const AdaptMotionOptions& options = {},
                                                 const Progress& progress = {});

}  // namespace marey::retarget
