// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/humanoid.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Difference of a segment's direction from the source's; for a group the segment with
/// the largest median over frames. Zeroes where a body lacks the segments.
struct DirectionFigures {
  HumanBone bone{};  ///< At the near end; kSpine means the trunk.
  double median_rad = 0.0;
  double worst_rad = 0.0;
  std::optional<int> worst_frame{};  ///< nullopt: a body lacks the segment.
  /// Largest angle that is exceeded for kSustained_s without interruption, and the start
  /// of that interval; 0 and nullopt if there is none.
  double sustained_rad = 0.0;
  std::optional<int> sustained_frame{};
};
/// Shorter departures are single frames or fast movements. [s]
inline constexpr double kSustained_s = 0.25;
/// Returns the name, such as "leftUpperLeg" or "trunk".
[[nodiscard]] std::string_view segment_name(const DirectionFigures& direction);

/// Number of compared segments: two of each limb, the trunk, the neck, two feet.
inline constexpr std::size_t kComparedSegments = 12;
/// Inclination above which a foot has no horizontal direction and is not compared. [rad]
inline constexpr double kSteepFoot_rad = 1.05;

/// Differences of a retargeted motion's postures from the source's.
struct PostureFigures {
  /// Individual segments: upper arm, forearm, thigh and shank of the left side, then of
  /// the right side, the trunk (kSpine), the line from neck to head (kNeck), the feet
  /// (kLeftFoot, kRightFoot).
  std::array<DirectionFigures, kComparedSegments> segments{};
  DirectionFigures legs;   ///< Thighs and shanks.
  DirectionFigures arms;   ///< Upper arms and forearms.
  DirectionFigures trunk;  ///< The line from mid-hip to mid-shoulder.
  /// Horizontal directions of the lines from ankle to toe joint: the height of an ankle
  /// over the toes depends on the body. Bodies without toe joints: the direction of the
  /// foot by its joint's rotation from the T-pose. For the foot with the larger
  /// `sustained_rad`.
  DirectionFigures feet;
  /// Share of frames in which the feet point backwards on one body only: left and right
  /// are exchanged.
  double exchanged_share = 0.0;
  /// Speed of the fastest joint, in body heights (head over floor at rest) per second.
  double max_speed = 0.0;
  HumanBone fastest_bone{};
  std::optional<int> fastest_frame{};  ///< nullopt: no joint moves.
  /// The same for the source.
  double source_max_speed = 0.0;
  HumanBone source_fastest_bone{};
  std::optional<int> source_fastest_frame{};
};

/// Compares postures by the positions of joints alone, independent of the rest poses.
/// Linear in frames. Precondition: the motions have the same number of frames; the maps
/// were made from the skeletons.
[[nodiscard]] PostureFigures compare_postures(const Motion& source,
                                              const BodyMap& from,
                                              const Motion& made,
                                              const BodyMap& to);

}  // namespace marey::retarget
