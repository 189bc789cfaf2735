// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <glm/vec3.hpp>

#include "core/human/body_track.h"

namespace marey::dynamics {

/// Length of an adult's foot. Heights of the rules below are for it; for other feet they
/// are scaled by the length. [m]
inline constexpr double kAdultFoot_m = 0.26;

/// Length of the soles of a track relative to kAdultFoot_m; 1 without soles.
[[nodiscard]] double foot_scale(const BodyTrack& track);

/// An instant at which the feet leave or meet the floor.
struct FootEdge {
  double time_s = 0.0;
  std::array<bool, 2> bears{};  ///< The feet that bear just before, or just after.
};

/// Finds the instant at which the last foot leaves the floor, near an estimate. A foot
/// leaves when its tip rises 25 mm above its lowest height of the 0.15 s before. The
/// instant is that at which the tip's upward speed, over 20 ms, passes 0.6 of its maximum
/// of the 40 ms after that: a tip leaves a push and a run at different speeds, and a
/// height alone is late for one or early for the other. nullopt: no foot leaves within
/// `tolerance_s`, or the track has no soles.
[[nodiscard]] std::optional<FootEdge> foot_takeoff(const BodyTrack& track,
                                                   double scale,
                                                   double near_s,
                                                   double tolerance_s);

/// Finds the instant at which the first foot meets the floor, near an estimate: the back
/// of its heel comes within 10 mm, or its tip within 15 mm, of its lowest height of the
/// 0.2 s after. A step has its own floor. The back of a heel is behind
/// and above the sole's rear end, over which a foot rolls. The tip of a foot whose toes
/// are not captured sinks a few millimetres into the floor.
[[nodiscard]] std::optional<FootEdge> foot_landing(const BodyTrack& track,
                                                   double scale,
                                                   double near_s,
                                                   double tolerance_s);

/// Height of the lowest point of both soles in a frame. Precondition: the track has
/// soles.
[[nodiscard]] double lowest_sole_m(const BodyTrack& track, std::size_t frame);

/// Returns the middle of the soles of these feet, or of both if none bears, at the height
/// of their lowest point. The frame is the one in which they are flattest in the
/// interval. Precondition: the track has soles; from_s <= to_s.
[[nodiscard]] glm::dvec3 standing_place(const BodyTrack& track,
                                        const std::array<bool, 2>& bears,
                                        double from_s,
                                        double to_s);

}  // namespace marey::dynamics
