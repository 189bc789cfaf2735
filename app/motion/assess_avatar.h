// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/motion/reread_motion.h"
#include "core/base/result.h"
#include "core/finding.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/skin.h"
#include "retarget/feet/lift_skin.h"
#include "retarget/motion/compare_postures.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

// Checks on a retargeted motion, applied to the written result. The limits below are
// those of docs/formats/README.md. Beyond a limit `kPoor...` the result is not usable:
// exit code 4.

/// Depth of skin below the floor, beyond the depth of the source's joints. [mm]
inline constexpr double kDeepSkin_mm = 5.0;
inline constexpr double kPoorSkin_mm = 30.0;
/// Angle between a leg segment, the trunk or the neck and the source's, median over
/// frames. [deg]
inline constexpr double kFarPosture_deg = 25.0;
inline constexpr double kPoorPosture_deg = 45.0;
/// The same limits for arms, which are moved aside on wide bodies. [deg]
inline constexpr double kFarArms_deg = 60.0;
inline constexpr double kPoorArms_deg = 90.0;
/// Angle between a foot and the source's that is exceeded for retarget::kSustained_s
/// without a break. [deg]
inline constexpr double kFarFoot_deg = 25.0;
inline constexpr double kPoorFoot_deg = 45.0;
/// Speed of the fastest joint, in body heights per second. It counts only where it is
/// also more than twice the source's.
inline constexpr double kPoorSpeed = 12.0;
/// The same limit for the source motion. No hand, foot or ball player reaches this speed;
/// a sample that jumps by a body height at 30 Hz does.
inline constexpr double kPoorSourceSpeed = 20.0;
/// Share of the frames in which left and right are exchanged.
inline constexpr double kPoorExchanged = 0.5;
/// Depth of arms and hands in trunk and thighs, beyond the source's. [mm]
inline constexpr double kDeepArms_mm = 60.0;

/// Angle between a segment and the source's (median over frames) above which the segment
/// is reported with the reason. [deg]
inline constexpr double kNamedPosture_deg = 8.0;
/// Distance between a bone in a written file and its solved position above which the file
/// is wrong. [mm]
inline constexpr double kRereadPlace_mm = 2.0;
/// Distance between a bone in a .vrma and its solved position, caused by the format,
/// above which there is a warning. [mm]
inline constexpr double kLostPlace_mm = 10.0;
/// Height at rest of a foot's lowest skin above the lowest skin of its leg, in leg
/// lengths, above which another joint is mapped as the foot.
inline constexpr double kFootAboveSkin = 0.1;

/// A segment whose direction differs from the source's, and the reason.
struct FarSegment {
  retarget::DirectionFigures direction;
  std::string because;  ///< The reason: "arms are kept out of the body".
};

/// Measurements and faults of a retargeted motion.
struct AvatarVerdict {
  /// Depth of the deformed skin below the floor; nullopt: the body has no skin.
  std::optional<retarget::SkinDepth> skin;
  retarget::SkinDepth beyond_source;  ///< Depth beyond that of the source's joints.
  double source_depth_m = 0.0;        ///< The largest RetargetReport::source_depth_m.
  retarget::PostureFigures posture;
  /// Segments beyond kNamedPosture_deg, in the order of PostureFigures::segments.
  std::vector<FarSegment> far_segments;
  /// Largest distance between a bone in a written file and its solved position [mm];
  /// nullopt: no file was read again.
  std::optional<double> reread_off_mm;
  double arms_in_body_mm = 0.0;  ///< ArmCollisionReport::max_depth_after_m, in mm.
  /// Faults; each states the body, the part, the frame and the next step. Poor beyond the
  /// gate.
  std::vector<Finding> problems;

  /// Returns the penetration of the skin into the floor, or of the ends of the feet if
  /// the body has no skin. [mm]
  [[nodiscard]] double penetration_mm(const retarget::RetargetReport& report) const;
};

/// Checks a motion by its written files. They are read again (reread_motion()), and the
/// skin of the .glb is measured.
///
/// `name` is the name of the body in messages. If feet were not kept on the floor
/// (`grounded` is false), skin below it is measured but is no fault. Cost:
/// reread_motion() of each file, and forward kinematics of both bodies and the skin,
/// about 10 us per frame.
/// Errors: map_body()'s, reread_motion()'s. Precondition: `skin` was made from the
/// motion's skeleton; `source` and the motion have equally many frames.
[[nodiscard]] Result<AvatarVerdict> assess_avatar(const std::string& name,
                                                  const Motion& source,
                                                  const retarget::RetargetedMotion& made,
                                                  const retarget::Skin& skin,
                                                  bool grounded,
                                                  std::span<const WrittenFile> files);

}  // namespace marey::app
