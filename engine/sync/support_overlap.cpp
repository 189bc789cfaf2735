// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/support_overlap.h"

#include <algorithm>

namespace marey::engine {
namespace {

/// A phase that ends sooner is left out: now is at its end but for rounding. [s]
constexpr double kOver_s = 1e-6;

/// Returns the part of a time from `start_s` to `end_s`, both within one phase of each
/// clip, in which the phases are incompatible.
double incompatible_part_s(const LeadCourse::Part& lead,
                           const PhaseRing& follower,
                           PhaseRing::Place place,
                           const CourseSegment& segment,
                           double start_s,
                           double end_s) {
  const PhaseClass feet = follower.feet(place);
  if (are_compatible(lead.feet, feet, 0.0)) {
    // Compatible everywhere, or near edges of flights only.
    if (are_compatible(lead.feet, feet, 2.0 * kFlightEdge_s)) return 0.0;
    const auto time_at = [&](double source_s) {
      return segment.start_s + (source_s - segment.source_s) / segment.rate;
    };
    start_s =
        std::max({start_s, lead.after_edge_s, time_at(follower.after_edge_s(place))});
    end_s = std::min({end_s, lead.before_edge_s, time_at(follower.before_edge_s(place))});
  }
  return std::max(0.0, end_s - start_s);
}

}  // namespace

LeadCourse lead_course(const SyncSide& lead, double horizon_s, std::size_t max_phases) {
  const PhaseRing ring(lead.phases, lead.duration_s, lead.loops);
  LeadCourse course;
  PhaseRing::Place place = ring.at(lead.now_s);
  const auto time_at = [&](double source_s) {
    return (source_s - lead.now_s) / lead.speed;
  };
  if (time_at(ring.end_s(place)) < kOver_s) place = ring.next(place);
  double start_s = 0.0;
  while (true) {
    const double end_s = time_at(ring.end_s(place));
    course.parts[course.count++] = {ring.feet(place),
                                    start_s,
                                    end_s,
                                    time_at(ring.after_edge_s(place)),
                                    time_at(ring.before_edge_s(place))};
    if (end_s >= horizon_s || course.count == max_phases) {
      course.horizon_s = std::min(horizon_s, end_s);
      return course;
    }
    start_s = end_s;
    place = ring.next(place);
  }
}

double incompatible_in(const LeadCourse& lead,
                       const PhaseRing& follower,
                       const CourseSegment& segment) {
  const double stop_s = std::min(segment.end_s, lead.horizon_s);
  double time_s = segment.start_s;
  std::size_t part = segment.lead_part;
  PhaseRing::Place place = segment.follower_part;
  double sum_s = 0.0;
  while (time_s < stop_s) {
    const double lead_end_s = lead.parts[part].end_s;
    const double follower_end_s =
        segment.start_s + (follower.end_s(place) - segment.source_s) / segment.rate;
    const double end_s = std::min({lead_end_s, follower_end_s, stop_s});
    sum_s +=
        incompatible_part_s(lead.parts[part], follower, place, segment, time_s, end_s);
    if (end_s >= stop_s) break;
    if (end_s >= lead_end_s) ++part;
    if (end_s >= follower_end_s) place = follower.next(place);
    time_s = std::max(time_s, end_s);
  }
  return sum_s;
}

}  // namespace marey::engine
