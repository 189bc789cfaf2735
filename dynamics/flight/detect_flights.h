// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dynamics/flight/com_slopes.h"
#include "dynamics/flight/foot_edges.h"

#include "core/human/body_track.h"

namespace marey::dynamics {

/// One end of a flight.
struct FlightEdge {
  double time_s = 0.0;
  /// The centre of mass's: its acceleration passes -0.75 of free fall.
  double by_com_s = 0.0;
  bool by_feet = false;         ///< `time_s` is that of the feet.
  std::array<bool, 2> bears{};  ///< Feet that bear before it, or after it.
};

/// An interval in which nothing bears the body. An end that the clip cuts is nullopt.
struct FreeFlight {
  std::optional<FlightEdge> takeoff;
  std::optional<FlightEdge> landing;
  double first_s = 0.0;  ///< Take-off, or the clip's first frame.
  double last_s = 0.0;   ///< Landing, or the clip's last frame.
};

struct DetectFlightsOptions {
  double fall_m_s2 = 9.81;  ///< Acceleration of free fall in the motion.
  double min_flight_s = 0.05;
};

/// Feet and centre of mass agree within this.
inline constexpr double kEdgeTolerance_s = 0.04;

/// Detects all flights, also cut ones: runs of frames with a fall of the centre of mass
/// of more than 0.6 of free fall, and a median above 0.8 of it. Their ends are the feet's
/// where these agree within kEdgeTolerance_s. A run in which
/// the soles do not rise from the floor by 20 mm, or 40 mm if no foot confirms an end, is
/// left out. Sorted by time; they do not overlap. Linear in frames. Preconditions:
/// those of find_jumps(); `slopes` are the track's.
[[nodiscard]] std::vector<FreeFlight> detect_flights(const BodyTrack& track,
                                                     const ComSlopes& slopes,
                                                     const DetectFlightsOptions& options);

}  // namespace marey::dynamics
