// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/marker_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"

namespace marey::edit {

Result<MarkerState> make_marker_state(MarkerTracks tracks, Annotations annotations) {
  if (tracks.frames() == 0) {
    return bad_input("markers",
                     tracks.labels.empty() ? "there are none" : "they have no frames",
                     "give a file with labelled markers");
  }
  if (!(tracks.rate.hz > 0.0) || !std::isfinite(tracks.rate.hz)) {
    return bad_input(
        "markers", "they have no frame rate", "export the file again with its rate");
  }
  for (std::size_t i = 0; i < tracks.samples.size(); ++i) {
    if (!tracks.samples[i]) continue;
    const glm::dvec3& p = tracks.samples[i]->p_in_world;
    if (std::isfinite(p.x + p.y + p.z)) continue;
    return bad_input("frame " + std::to_string(i / tracks.markers()),
                     "marker " + tracks.labels[i % tracks.markers()] +
                         " has a coordinate that is not finite",
                     "export the file again");
  }
  MarkerState out;
  out.lineage = lineage_of_source(0, static_cast<int>(tracks.frames()));
  out.tracks = std::move(tracks);
  out.annotations = std::move(annotations);
  return out;
}

Timeline timeline_of(const MarkerState& state) {
  return {state.frame_count(), state.tracks.rate.hz, state.annotations.notes, {}};
}

std::vector<FrameRange> seen_runs(const MarkerTracks& tracks, std::size_t marker) {
  MAREY_ASSERT(marker < tracks.markers());
  std::vector<FrameRange> out;
  const int frames = static_cast<int>(tracks.frames());
  bool was_seen = false;
  for (int frame = 0; frame < frames; ++frame) {
    const bool is_seen = tracks.at(static_cast<std::size_t>(frame), marker).has_value();
    if (is_seen && !was_seen) out.push_back({frame, frame});
    if (is_seen) out.back().last = frame;
    was_seen = is_seen;
  }
  return out;
}

std::string label_list(const std::vector<std::string>& labels) {
  constexpr std::size_t kAll = 5;
  constexpr std::size_t kSome = 3;
  const std::size_t shown = labels.size() <= kAll ? labels.size() : kSome;
  std::string out;
  for (std::size_t i = 0; i < shown; ++i) out += (i > 0 ? ", " : "") + labels[i];
  if (shown < labels.size()) {
    out += " and " + std::to_string(labels.size() - shown) + " more";
  }
  return out;
}

}  // namespace marey::edit
