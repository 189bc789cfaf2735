// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/place_markers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/resolve_moment.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/format_text.h"

namespace marey::edit {
namespace {

constexpr double kMarkersTravel_m = 0.3;

/// Returns the place of a marker at a frame with its fraction; nullopt: not seen.
std::optional<glm::dvec3> place_at(const MarkerTracks& tracks,
                                   std::size_t marker,
                                   double frame) {
  const auto before = static_cast<std::size_t>(frame);
  const auto& a = tracks.at(before, marker);
  const double share = frame - static_cast<double>(before);
  if (share == 0.0) return a ? std::optional(a->p_in_world) : std::nullopt;
  const auto& b = tracks.at(before + 1, marker);
  if (!a || !b) return std::nullopt;
  return glm::mix(a->p_in_world, b->p_in_world, share);
}

/// Mean of markers.
struct MarkerMean {
  glm::dvec3 sum{0.0};
  int count = 0;

  void add(const glm::dvec3& p) {
    sum += p;
    ++count;
  }
  [[nodiscard]] glm::dvec3 value() const { return sum / static_cast<double>(count); }
};

Result<double> travel_heading_rad(const MarkerState& state, const ResolvedSpan& span) {
  MarkerMean travel;
  int first_count = 0;
  int last_count = 0;
  for (std::size_t m = 0; m < state.tracks.markers(); ++m) {
    const auto first = place_at(state.tracks, m, span.first);
    const auto last = place_at(state.tracks, m, span.last);
    if (first) ++first_count;
    if (last) ++last_count;
    if (first && last) travel.add(*last - *first);
  }
  if (travel.count == 0 || 2 * travel.count < std::max(first_count, last_count)) {
    return bad_input("heading_deg",
                     format_text("the direction of travel is not known: %d markers are "
                                 "seen at the start of the span, %d at its end, %d at "
                                 "both",
                                 first_count,
                                 last_count,
                                 travel.count),
                     "give a span that starts and ends with most markers, or fill the "
                     "gaps with marey repair");
  }
  const glm::dvec3 way = travel.value();
  const double way_m = std::hypot(way.x, way.z);
  if (way_m < kMarkersTravel_m) {
    return bad_input("heading_deg",
                     format_text("has no meaning here: the markers travel only %.2f m "
                                 "over the span (at least %.1f m)",
                                 way_m,
                                 kMarkersTravel_m),
                     "give a span in which they travel, or solve the markers first "
                     "(marey fit) and place the motion: a body has a front");
  }
  return std::atan2(way.x, way.z);
}

}  // namespace

Result<MarkerState> place_markers(const PlaceOp& op,
                                  const MarkerOpContext& context,
                                  const MarkerState& state,
                                  OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true}); !ok) return ok.error();
  if (!op.position_xz_m && !op.heading_rad) {
    return bad_input(
        "place", "has neither a position nor a heading", "state one of them");
  }
  const Timeline timeline = timeline_of(state);
  const auto at = resolve_moment(timeline, op.at);
  if (!at) return at.error();
  const auto span = resolve_span(timeline, context.op.span);
  if (!span) return span.error();
  MarkerMean seen;
  for (std::size_t m = 0; m < state.tracks.markers(); ++m) {
    if (const auto p = place_at(state.tracks, m, *at)) seen.add(*p);
  }
  if (seen.count == 0) {
    return bad_input("at",
                     format_text("no marker is seen at frame %.1f", *at),
                     "choose an instant at which markers are seen");
  }
  double turn_rad = 0.0;
  if (op.heading_rad) {
    const auto heading_rad = travel_heading_rad(state, *span);
    if (!heading_rad) return heading_rad.error();
    turn_rad = *op.heading_rad - *heading_rad;
  }
  const glm::dvec3 pivot = seen.value();
  glm::dvec3 target = pivot;
  if (op.position_xz_m) target = {op.position_xz_m->x, pivot.y, op.position_xz_m->y};
  const RigidTransform new_from_old = turn_about(pivot, turn_rad, target);
  MarkerState out = state;
  out.is_moved = true;
  for (std::optional<MarkerSample>& sample : out.tracks.samples) {
    if (sample) sample->p_in_world = new_from_old * sample->p_in_world;
  }
  touch(out.lineage, {0, out.frame_count() - 1}, context.index);
  report.figures.emplace_back("turn_deg", glm::degrees(turn_rad));
  report.figures.emplace_back("moved_m", glm::distance(pivot, target));
  report.figures.emplace_back("markers_used", seen.count);
  return out;
}

}  // namespace marey::edit
