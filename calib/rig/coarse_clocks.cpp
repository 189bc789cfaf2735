// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/coarse_clocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "calib/model/consensus.h"
#include "calib/model/estimate_intrinsics.h"

namespace marey::calib {
namespace {

/// A SeenTrack by time steps instead of frames.
using Track = SeenTrack;

constexpr std::size_t kMaxPoses = 120;

Track thinned(const Track& track) {
  if (track.size() <= kMaxPoses) return track;
  Track out;
  std::size_t i = 0;
  for (const auto& [key, pose] : track) {
    if (i * kMaxPoses / track.size() != (i + 1) * kMaxPoses / track.size()) {
      out[key] = pose;
    }
    ++i;
  }
  return out;
}

struct ClockFit {
  double score = 0.0;
  int lag = 0;  ///< Steps by which b's frames are shifted.
};

ClockFit best_lag(const Track& a, const Track& b, int maximum) {
  ClockFit best;
  const Track few = thinned(a);
  for (int lag = -maximum; lag <= maximum; ++lag) {
    std::vector<RigidTransform> proposals;
    for (const auto& [key, a_from_thing] : few) {
      const auto other = b.find({key.first, key.second - lag});
      if (other == b.end()) continue;
      proposals.push_back(a_from_thing * inverse(other->second));
    }
    if (proposals.size() < 4) continue;
    const Link link = medoid_transform(0, 1, proposals);
    const double score = link.support * (kMaxDisagreement - link.spread);
    // For equal scores the smaller lag is used: a board at rest agrees at every lag.
    const bool better =
        score > 1.001 * best.score ||
        (score > 0.999 * best.score && std::abs(lag) < std::abs(best.lag));
    if (better) best = {score, lag};
  }
  return best;
}

}  // namespace

std::vector<double> coarse_offsets_s(std::span<const SeenTrack> seen,
                                     std::span<const CameraDetections> waved,
                                     double max_s) {
  const std::size_t count = waved.size();
  double step_s = 0.0;
  for (const CameraDetections& camera : waved) {
    step_s = std::max(step_s, 1.0 / camera.rate.hz);
  }
  std::vector<Track> tracks(count);
  for (std::size_t c = 0; c < count; ++c) {
    for (const auto& [key, pose] : seen[c]) {
      const double time_s = key.second / waved[c].rate.hz;
      tracks[c][{key.first, static_cast<int>(std::lround(time_s / step_s))}] = pose;
    }
  }
  const int maximum = static_cast<int>(std::lround(max_s / step_s));
  std::vector<std::optional<double>> offset_s(count);
  if (count > 0) offset_s[0] = 0.0;
  std::map<std::pair<std::size_t, std::size_t>, ClockFit> fits;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      fits[{a, b}] = best_lag(tracks[a], tracks[b], maximum);
    }
  }
  // Best supported link first, as in propagate_poses().
  while (true) {
    const std::pair<const std::pair<std::size_t, std::size_t>, ClockFit>* best = nullptr;
    for (const auto& fit : fits) {
      const auto& [a, b] = fit.first;
      const bool is_new = offset_s[a].has_value() != offset_s[b].has_value();
      const bool is_sure = fit.second.score > 0.0;
      if (is_new && is_sure && (!best || fit.second.score > best->second.score)) {
        best = &fit;
      }
    }
    if (!best) break;
    const auto& [a, b] = best->first;
    const double lag_s = best->second.lag * step_s;
    if (offset_s[a]) {
      offset_s[b] = *offset_s[a] + lag_s;
    } else {
      offset_s[a] = *offset_s[b] - lag_s;
    }
  }
  std::vector<double> out;
  for (const auto& offset : offset_s) out.push_back(offset.value_or(0.0));
  return out;
}

std::vector<double> coarse_offsets_s(std::span<const BoardView> views,
                                     std::span<const Intrinsics> intrinsics,
                                     std::span<const CameraDetections> waved,
                                     double max_s) {
  std::vector<SeenTrack> tracks(waved.size());
  for (const BoardView& view : views) {
    if (view.instant == kFloorInstant) continue;
    const std::size_t c = index(view.camera);
    const auto pose = camera_from_board(intrinsics[c], view);
    if (pose) tracks[c][{0, view.instant}] = *pose;
  }
  return coarse_offsets_s(tracks, waved, max_s);
}

}  // namespace marey::calib
