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
};
/// "leftUpperLeg", "trunk".
[[nodiscard]] std::string_view segment_name(const DirectionFigures& direction);

/// Segments that are compared: two of each limb, the trunk, the neck.
inline constexpr std::size_t kComparedSegments = 10;

/// How far a retargeted motion's postures are from the source's.
struct PostureFigures {
  /// Each segment by itself: upper arm, forearm, thigh and shank of the left side, then
  /// of the right side, the trunk (kSpine), the line from neck to head (kNeck).
  std::array<DirectionFigures, kComparedSegments> segments{};
  DirectionFigures legs;   ///< Thighs and shanks.
  DirectionFigures arms;   ///< Upper arms and forearms.
  DirectionFigures trunk;  ///< The line from mid-hip to mid-shoulder.
  /// Share of frames in which the feet point backwards on one body and not on the other:
  /// left and right are exchanged.
  double exchanged_share = 0.0;
  /// The fastest joint, in body heights (head over floor at rest) per second.
  double fastest = 0.0;
  HumanBone fastest_bone{};
  int fastest_frame = -1;
  double source_fastest = 0.0;  ///< The same of the source.
};

/// Compares by the places of joints alone, which the rest poses do not touch. Linear in
/// frames. Precondition: as many frames; the maps were made from the skeletons.
[[nodiscard]] PostureFigures compare_postures(const Motion& source,
                                              const BodyMap& from,
                                              const Motion& made,
                                              const BodyMap& to);

}  // namespace marey::retarget
