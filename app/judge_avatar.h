// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/motion.h"
#include "core/result.h"
#include "retarget/body_map.h"
#include "retarget/compare_postures.h"
#include "retarget/lift_skin.h"
#include "retarget/retarget_motion.h"
#include "retarget/skin.h"

namespace marey::app {

// What a retargeted motion is judged by, as it leaves: the limits below are those of
// docs/formats.md. Beyond `kPoor...` the result is not to be trusted: exit code 4.

/// Skin below the floor, deeper than the source's joints are. [mm]
inline constexpr double kDeepSkin_mm = 5.0;
inline constexpr double kPoorSkin_mm = 30.0;
/// Median over frames of the angle between a leg's segment, or the trunk, and the
/// source's. [deg]
inline constexpr double kFarPosture_deg = 25.0;
inline constexpr double kPoorPosture_deg = 45.0;
/// The same of arms, which give way to wide bodies. [deg]
inline constexpr double kFarArms_deg = 60.0;
inline constexpr double kPoorArms_deg = 90.0;
/// The fastest joint in body heights per second, where it is also over twice as fast as
/// the source's.
inline constexpr double kPoorSpeed = 12.0;
/// Share of frames with left and right exchanged.
inline constexpr double kPoorExchanged = 0.5;
/// Arms and hands in trunk and thighs, deeper than the source's. [mm]
inline constexpr double kDeepArms_mm = 60.0;

/// One thing that is wrong with an avatar's motion.
struct AvatarProblem {
  Error error;  ///< kQuality; names the body, the part, the frame, the next step.
  bool is_poor = false;  ///< Beyond the gate.
};

/// What a retargeted motion shows.
struct AvatarVerdict {
  /// Of the deformed skin, against the floor; nullopt: the body has no skin.
  std::optional<retarget::SkinDepth> skin;
  retarget::SkinDepth beyond_source;  ///< The same, beyond what the source's joints are.
  double source_depth_m = 0.0;        ///< The largest RetargetReport::source_depth_m.
  retarget::PostureFigures posture;
  double arms_in_body_mm = 0.0;  ///< ClearArmsReport::deepest_after_m.
  std::vector<AvatarProblem> problems;

  /// deepest_penetration_mm: of the skin, without one of the feet's ends.
  [[nodiscard]] double penetration_mm(const retarget::RetargetReport& report) const;
};

/// Judges a motion as it is delivered.
///
/// `name` is what messages call the body. Where feet were not kept to the floor
/// (`grounded` is false), skin below it is measured and no problem. Costs a forward
/// kinematics of both bodies and the skin near the floor, some ten microseconds a frame.
/// Errors: map_body()'s. Precondition: `skin` was made from the motion's skeleton; as
/// many frames in `source` as in the motion.
[[nodiscard]] Result<AvatarVerdict> judge_avatar(const std::string& name,
                                                 const Motion& source,
                                                 const retarget::RetargetedMotion& made,
                                                 const retarget::Skin& skin,
                                                 bool grounded);

}  // namespace marey::app
