// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/constraint.h"
#include "core/motion.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::retarget {

struct AdaptMotionOptions {
  AdaptOptions adapt;
  /// Names of the character's loads that are carried from the first frame on; other loads
  /// are not carried. The target of the centre of mass, load included, is the position of
  /// the body's own centre of mass in the motion, or that position moved with the
  /// supports (Adapter::set_balance_target()).
  std::vector<std::string> carried;
  /// Targets of the centre of mass, loads included, one per frame; empty: those of the
  /// motion. BalanceMode::kZmp needs them.
  std::span<const glm::dvec3> com_in_world{};
};

/// Errors of one constraint over the frames in which it is fully active.
struct KeptConstraint {
  std::string id;
  bool is_support = false;
  int active_frames = 0;
  bool is_orientation = false;  ///< True: the errors are angles, and the lengths are 0.
                                ///< False: the reverse.
  int met_frames = 0;           ///< Frames in which is_met() of
                                ///< retarget/constraints/measure_constraint.h is true.
  double mean_error_m = 0.0;
  double worst_error_m = 0.0;
  double mean_error_rad = 0.0;
  double worst_error_rad = 0.0;
  /// Index in the motion's poses; nullopt: the constraint was never fully active.
  std::optional<int> worst_frame{};
  /// True if max_iterations ended the solve of a frame in which the constraint was not
  /// met.
  bool ran_out = false;
};

/// Largest acceleration that adaptation added to a joint, relative to the joint's path in
/// the source motion. A fade of T seconds over s metres has a peak of 5.8 s / T^2; much
/// larger values mean that the posture jumped.
struct AddedAcceleration {
  double m_per_s2 = 0.0;
  JointIndex joint{};
  int frame = 0;  ///< Index in the motion's poses.
};

struct AdaptedMotion {
  Motion motion;
  std::vector<KeptConstraint> constraints;  ///< In the order of the set, its supports
                                            ///< included.
  std::vector<KeptConstraint> supports;     ///< In the order of the tracks.
  double mean_iterations = 0.0;
  int max_iterations = 0;
  int capped_frames = 0;  ///< Number of frames with AdaptReport::capped.
  double mean_balance_error_m = 0.0;
  double worst_balance_error_m = 0.0;
  int worst_balance_frame = 0;  ///< Index in the motion's poses.
  AddedAcceleration added;
};

/// Adapts every posture of a motion (Kulpa 2005, 4 and 5) to constraints and to the
/// supports of its feet. Frame numbers, rate and names are those of the motion; frame i
/// is at time (first_frame + i) / rate. Deterministic to the byte. Errors are measured by
/// forward kinematics on the result (retarget/constraints/measure_constraint.h). Costs
/// one Adapter::adapt() per frame.
///
/// Errors (bad input): those of Adapter::make(); a load that the character does not have.
/// Precondition: the motion has the character's skeleton; the rate is positive; the
/// tracks and options.com_in_world have the frames of the motion, unless empty.
[[nodiscard]] Result<AdaptedMotion> adapt_motion(const Motion& motion,
                                                 const Character& character,
                                                 const ConstraintSet& constraints,
                                                 std::span<const SupportTrack> supports,
                                                 const AdaptMotionOptions& options = {},
                                                 const Progress& progress = {});

}  // namespace marey::retarget
