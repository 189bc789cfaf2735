// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/humanoid.h"
#include "core/motion.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// How far the direction of a segment is from the source's: the segment of a group whose
/// median over frames is the largest. Zeroes where a body lacks them.
struct DirectionFigures {
  HumanBone bone{};  ///< At the near end; kSpine means the trunk.
  double median_rad = 0.0;
  double worst_rad = 0.0;
  int worst_frame = -1;
  /// The largest angle that is exceeded for kSustained_s on end, and where that begins.
  double sustained_rad = 0.0;
  int sustained_frame = -1;
};
/// Shorter departures are a frame's or a fast movement's. [s]
inline constexpr double kSustained_s = 0.25;
/// "leftUpperLeg", "trunk".
[[nodiscard]] std::string_view segment_name(const DirectionFigures& direction);

/// Segments that are compared: two of each limb, the trunk, the neck, two feet.
inline constexpr std::size_t kComparedSegments = 12;
/// A foot steeper than this has no direction over the floor, and is not compared. [rad]
inline constexpr double kSteepFoot_rad = 1.05;

/// How far a retargeted motion's postures are from the source's.
struct PostureFigures {
  /// Each segment by itself: upper arm, forearm, thigh and shank of the left side, then
  /// of the right side, the trunk (kSpine), the line from neck to head (kNeck), the feet
  /// (kLeftFoot, kRightFoot).
  std::array<DirectionFigures, kComparedSegments> segments{};
  DirectionFigures legs;   ///< Thighs and shanks.
  DirectionFigures arms;   ///< Upper arms and forearms.
  DirectionFigures trunk;  ///< The line from mid-hip to mid-shoulder.
  /// Where the lines from ankle to toe joint point over the floor: how high an ankle lies
  /// over the toes is the body's. Bodies without toe joints: where the foot points by its
  /// joint's turn from the T-pose. Of the foot with the larger `sustained_rad`.
  DirectionFigures feet;
  /// Share of frames in which the feet point backwards on one body and not on the other:
  /// left and right are exchanged.
  double exchanged_share = 0.0;
  /// The fastest joint, in body heights (head over floor at rest) per second.
  double fastest = 0.0;
  HumanBone fastest_bone{};
  int fastest_frame = -1;
  /// The same of the source.
  double source_fastest = 0.0;
  HumanBone source_fastest_bone{};
  int source_fastest_frame = -1;
};

/// Compares by the places of joints alone, which the rest poses do not touch. Linear in
/// frames. Precondition: as many frames; the maps were made from the skeletons.
[[nodiscard]] PostureFigures compare_postures(const Motion& source,
                                              const BodyMap& from,
                                              const Motion& made,
                                              const BodyMap& to);

}  // namespace marey::retarget
