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
  double min_flight_s = 0.05;  ///< Shorter flights are left out.
  /// Start of the push of the first jump that takes off after it, set by the user.
  std::optional<double> start_s{};
};

/// Finds the jumps of a motion (docs/jumps.md): every flight whose take-off is in the
/// clip, so also steps of a run and a fall from a box. Candidates are runs in which the
/// centre of mass falls with more than 0.6 g; their ends are refined by the feet
/// (flight/foot_edges.h). Where the feet give no instant within 40 ms of the centre of
/// mass's (its acceleration passes -0.75 g), the end is the latter, kInferred, with a
/// finding. The states at take-off and touch-down are from one robust fit (Huber at 5 mm)
/// of a parabola to all frames of the flight; a flight with fewer than two frames is left
/// out. If the flight does not fall at the expected rate, gravity is the captured one,
/// with a finding.
/// The push begins (P1) at the touch-down of a flight that ended less than 1 s before the
/// take-off; else at the end of the last 50 ms before the lowest point in which the body
/// stood (below 8 cm/s and 0.1 g); else at the last highest point before it; else at the
/// clip's start, with a finding. The lowest point (P2) is within 1.5 s before the
/// take-off. The landing ends (P5) at the first frame of 0.1 s below 10 cm/s, or at the
/// next take-off.
/// Sorted by time; empty: the body never leaves the floor. Linear in frames.
/// Preconditions: rate above 0; all positions finite; soles empty or one per frame.
[[nodiscard]] std::vector<Jump> find_jumps(const BodyTrack& track,
                                           const FindJumpsOptions& options = {});

}  // namespace marey::dynamics
