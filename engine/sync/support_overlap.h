// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/sync/phase_ring.h"
#include "engine/sync/sync_side.h"

namespace marey::engine {

/// Maximum number of phases of a lead in a plan.
inline constexpr std::size_t kMaxLeadPhases = 8;

/// The phases of a lead over the time from now. [s]
struct LeadCourse {
  struct Part {
    PhaseClass feet = PhaseClass::kAny;
    double start_s = 0.0;
    double end_s = 0.0;
    /// More than kFlightEdge_s of the clip from edges of flights between these.
    double after_edge_s = 0.0;
    double before_edge_s = 0.0;
  };
  /// The last one may end beyond the horizon.
  std::array<Part, kMaxLeadPhases> parts{};
  std::size_t count = 0;
  double horizon_s = 0.0;  ///< At most the asked one, and the end of the last part.
};

/// Returns the phases of a lead up to a horizon, at most `max_phases` of them.
[[nodiscard]] LeadCourse lead_course(const SyncSide& lead,
                                     double horizon_s,
                                     std::size_t max_phases);

/// A part of a follower's course with a constant rate.
struct CourseSegment {
  double start_s = 0.0;  ///< From now.
  double end_s = 0.0;
  double source_s = 0.0;           ///< At the start.
  double rate = 1.0;               ///< Clip seconds per second: > 0.
  std::size_t lead_part = 0;       ///< At the start.
  PhaseRing::Place follower_part;  ///< At the start.
};

/// Returns the time within a segment, up to the lead's horizon, in which the supports of
/// both are incompatible. Linear in the phases that it passes. [s]
[[nodiscard]] double incompatible_in(const LeadCourse& lead,
                                     const PhaseRing& follower,
                                     const CourseSegment& segment);

}  // namespace marey::engine
