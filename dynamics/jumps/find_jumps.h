// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/push/push_ends.h"

#include "core/human/body_track.h"

namespace marey::dynamics {

struct FindJumpsOptions {
  double gravity_m_s2 = kStandardGravity_m_s2;  ///< 0.5 to 30.
  /// Gravity that the motion is expected to show, where that differs: a motion that was
  /// scaled to another body falls at the scaled rate. nullopt: gravity_m_s2.
  std::optional<double> expected_fall_m_s2{};
  double min_flight_s = 0.08;
  /// Start of the push of the jump that contains this instant's flight, set by the user.
  std::optional<double> start_s{};
};

/// Finds the jumps of a motion (docs/jumps.md): candidates are runs in which the centre
/// of mass falls with more than 0.6 g; their ends are refined by the feet. Take-off: the
/// last foot's tip is 25 mm (scaled with the foot) above its lowest height of the 0.15 s
/// before. Landing: the first foot's lowest point comes within 10 mm of its lowest height
/// of the 0.2 s after. Between frames both are interpolated. The states at take-off and
/// touch-down are from one robust fit (Huber at 5 mm) of a parabola to all frames of the
/// flight. Sorted by time; empty: the body never leaves the floor. Linear in frames.
/// Preconditions: rate above 0; all positions finite; soles empty or one per frame.
[[nodiscard]] std::vector<Jump> find_jumps(const BodyTrack& track,
                                           const FindJumpsOptions& options = {});

}  // namespace marey::dynamics
