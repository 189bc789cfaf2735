// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/motion/reread_motion.h"
#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/skin.h"
#include "retarget/feet/lift_skin.h"
#include "retarget/motion/compare_postures.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

// What a retargeted motion is judged by, as it leaves: the limits below are those of
// docs/formats/README.md. Beyond `kPoor...` the result is not to be trusted: exit code 4.

/// Skin below the floor, deeper than the source's joints are. [mm]
inline constexpr double kDeepSkin_mm = 5.0;
inline constexpr double kPoorSkin_mm = 30.0;
/// Median over frames of the angle between a leg segment, the trunk or the neck and the
/// source's. [deg]
inline constexpr double kFarPosture_deg = 25.0;
inline constexpr double kPoorPosture_deg = 45.0;
/// The same of arms, which give way to wide bodies. [deg]
inline constexpr double kFarArms_deg = 60.0;
inline constexpr double kPoorArms_deg = 90.0;
/// Angle of a foot to the source's that is exceeded for retarget::kSustained_s on end.
/// [deg]
inline constexpr double kFarFoot_deg = 25.0;
inline constexpr double kPoorFoot_deg = 45.0;
/// The fastest joint in body heights per second, where it is also over twice as fast as
/// the source's.
inline constexpr double kPoorSpeed = 12.0;
/// The same of the motion that was given: no hand, foot or ball player reaches it, a
/// sample that jumps by a body height at 30 Hz does.
inline constexpr double kPoorSourceSpeed = 20.0;
/// Share of frames with left and right exchanged.
inline constexpr double kPoorExchanged = 0.5;
/// Arms and hands in trunk and thighs, deeper than the source's. [mm]
inline constexpr double kDeepArms_mm = 60.0;

/// A segment whose angle to the source's is larger is reported, with the reason (median
/// over frames). [deg]
inline constexpr double kNamedPosture_deg = 8.0;
/// Distance of a bone in a written file from its solved place: beyond, the file is
/// wrong. [mm]
inline constexpr double kRereadPlace_mm = 2.0;
/// Distance of a bone in a .vrma from its solved place that the format cannot hold:
/// beyond, a warning. [mm]
inline constexpr double kLostPlace_mm = 10.0;
/// Height of a foot's lowest skin at rest above the lowest skin of its leg, in lengths of
/// the leg: beyond, another joint is mapped as the foot.
inline constexpr double kFootAboveSkin = 0.1;

/// One thing that is wrong with an avatar's motion.
struct AvatarProblem {
  Error error;  ///< kQuality; names the body, the part, the frame, the next step.
  bool is_poor = false;  ///< Beyond the gate.
};

/// A segment that points elsewhere than the source's, and the reason.
struct FarSegment {
  retarget::DirectionFigures direction;
  std::string because;  ///< The reason: "arms are kept out of the body".
};

/// What a retargeted motion shows.
struct AvatarVerdict {
  /// Of the deformed skin, against the floor; nullopt: the body has no skin.
  std::optional<retarget::SkinDepth> skin;
  retarget::SkinDepth beyond_source;  ///< The same, beyond what the source's joints are.
  double source_depth_m = 0.0;        ///< The largest RetargetReport::source_depth_m.
  retarget::PostureFigures posture;
  /// Beyond kNamedPosture_deg, in the order of PostureFigures::segments.
  std::vector<FarSegment> far_segments;
  /// The largest distance of a bone's place in a written file from where it was solved
  /// [mm]; nullopt: no file was read again.
  std::optional<double> reread_off_mm;
  double arms_in_body_mm = 0.0;  ///< ArmCollisionReport::deepest_after_m.
  std::vector<AvatarProblem> problems;

  /// deepest_penetration_mm: of the skin, without one of the feet's ends.
  [[nodiscard]] double penetration_mm(const retarget::RetargetReport& report) const;
};

/// Judges a motion by its written files: they are read again (reread_motion()), and the
/// skin is that of the .glb.
///
/// `name` is what messages call the body. Where feet were not kept to the floor
/// (`grounded` is false), skin below it is measured and no problem. Cost: reread_motion()
/// of each file, and forward kinematics of both bodies and the skin, some 10 us a frame.
/// Errors: map_body()'s, reread_motion()'s. Precondition: `skin` was made from the
/// motion's skeleton; as many frames in `source` as in the motion.
[[nodiscard]] Result<AvatarVerdict> assess_avatar(const std::string& name,
                                                  const Motion& source,
                                                  const retarget::RetargetedMotion& made,
                                                  const retarget::Skin& skin,
                                                  bool grounded,
                                                  std::span<const WrittenFile> files);

}  // namespace marey::app
