// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/complete_markers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"

namespace marey::app {
namespace {

// Samples with a larger sigma are left empty, as by `marey repair`.
constexpr double kMaxSigma_m = 0.1;

}  // namespace

CompletedMarkers complete_markers(const Body& body,
                                  const reconstruct::SolvedMarkers& solved,
                                  MarkerTracks tracks) {
  CompletedMarkers out;
  out.tracks = std::move(tracks);
  const std::size_t placed = body.markers.size();
  const std::size_t frames = out.tracks.frames();
  MAREY_ASSERT(solved.modelled_in_world.size() == frames * placed);
  for (std::size_t m = 0; m < out.tracks.markers(); ++m) {
    const auto found =
        std::find_if(body.markers.begin(), body.markers.end(), [&](const auto& marker) {
          return marker.label == out.tracks.labels[m];
        });
    const auto at = static_cast<std::size_t>(found - body.markers.begin());
    for (std::size_t f = 0; f < frames; ++f) {
      auto& sample = out.tracks.at(f, m);
      if (sample) continue;
      ++out.empty;
      if (found == body.markers.end()) continue;
      // Joints of marey's own skeletons are bones.
      const JointUncertainty& uncertainty =
          solved.estimate.uncertainty[f][index(found->segment)];
      if (uncertainty.source == Source::kInferred) continue;
      const double sigma_m =
          std::hypot(found->stray_m, found->sigma_m, uncertainty.sigma_m);
      if (sigma_m > kMaxSigma_m) continue;
      sample = MarkerSample{solved.modelled_in_world[f * placed + at],
                            static_cast<float>(sigma_m),
                            0,
                            Source::kInferred};
      --out.empty;
      ++out.predicted;
    }
  }
  return out;
}

}  // namespace marey::app
