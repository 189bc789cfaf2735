// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/resample_markers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "edit/state/frame_places.h"
#include "edit/state/time_map.h"

#include "core/base/assert.h"
#include "core/signal/cubic_spline.h"

namespace marey::edit {
namespace {

/// The splines through the places of one marker in a run of frames.
class RunCurve {
 public:
  RunCurve(const MarkerTracks& tracks, std::size_t marker, const FrameRange& run) {
    std::vector<double> knots;
    std::array<std::vector<double>, 3> values;
    for (int frame = run.first; frame <= run.last; ++frame) {
      const auto& sample = tracks.at(static_cast<std::size_t>(frame), marker);
      knots.push_back(frame);
      for (int axis = 0; axis < 3; ++axis) {
        values[static_cast<std::size_t>(axis)].push_back(sample->p_in_world[axis]);
      }
    }
    for (const auto& channel : values) curves_.emplace_back(knots, channel);
  }

  [[nodiscard]] glm::dvec3 at(double frame) const {
    return {curves_[0].at(frame), curves_[1].at(frame), curves_[2].at(frame)};
  }

 private:
  std::vector<CubicSpline> curves_;
};

MarkerSample between_samples(const MarkerSample& a,
                             const MarkerSample& b,
                             const glm::dvec3& p_in_world) {
  MarkerSample out;
  out.p_in_world = p_in_world;
  out.sigma_m = std::max(a.sigma_m, b.sigma_m);
  out.cameras = static_cast<std::uint8_t>(a.cameras & b.cameras);
  out.source = worse_source(a.source, b.source);
  return out;
}

/// Sets the samples of one marker that lie between two frames.
void resample_marker(const MarkerTracks& from,
                     std::size_t marker,
                     const std::vector<FramePlace>& places,
                     MarkerTracks& out) {
  std::size_t place = 0;
  for (const FrameRange& run : seen_runs(from, marker)) {
    const auto first = static_cast<std::size_t>(run.first);
    const auto last = static_cast<std::size_t>(run.last);
    while (place < places.size() && places[place].before < first) ++place;
    if (first == last) continue;
    const auto lies_within = [&] {
      return place < places.size() && places[place].before < last;
    };
    if (!lies_within()) continue;
    const RunCurve curve(from, marker, run);
    for (; lies_within(); ++place) {
      const auto [before, share] = places[place];
      if (share == 0.0) continue;
      out.at(place, marker) =
          between_samples(*from.at(before, marker),
                          *from.at(before + 1, marker),
                          curve.at(static_cast<double>(before) + share));
    }
  }
}

bool is_part(const std::vector<FramePlace>& places) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].share != 0.0 || places[k].before != places[0].before + k) return false;
  }
  return true;
}

MarkerTracks resample_tracks(const MarkerTracks& from,
                             const std::vector<FramePlace>& places,
                             double rate_hz) {
  MarkerTracks out;
  out.labels = from.labels;
  out.rate = FrameRate{rate_hz};
  if (is_part(places) && rate_hz == from.rate.hz) {
    out.first_frame = from.first_frame + static_cast<int>(places[0].before);
    out.start_s = from.time_s(places[0].before);
  }
  out.samples.resize(places.size() * from.markers());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].share != 0.0) continue;
    for (std::size_t m = 0; m < from.markers(); ++m) {
      out.at(k, m) = from.at(places[k].before, m);
    }
  }
  const bool is_slice = std::all_of(
      places.begin(), places.end(), [](const FramePlace& p) { return p.share == 0.0; });
  if (is_slice) return out;
  for (std::size_t m = 0; m < from.markers(); ++m) resample_marker(from, m, places, out);
  return out;
}

}  // namespace

MarkerState resample_markers(const MarkerState& state,
                             std::span<const double> at_frame,
                             double rate_hz) {
  MAREY_ASSERT(rate_hz > 0.0 && !at_frame.empty());
  const std::vector<FramePlace> places = frame_places(at_frame, state.tracks.frames());
  MarkerState out;
  out.is_moved = state.is_moved;
  out.tracks = resample_tracks(state.tracks, places, rate_hz);
  out.lineage = resample_lineage(state.lineage, places);
  out.annotations = resample_annotations(
      state.annotations, places, TimeMap(at_frame, state.tracks.rate.hz, rate_hz));
  return out;
}

}  // namespace marey::edit
