// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/motion.h"
#include "reconstruct/markers/fit_markers.h"

namespace marey::testing {

/// A person who moves every joint, with markers on known places.
struct MovingBody {
  Body body;            ///< Ground truth, including markers' places.
  Motion motion;        ///< Motion of make_humanoid(body.proportions).
  MarkerTracks tracks;  ///< Exact except for `noise_m`.
  std::vector<reconstruct::NamedMarker> labels;
};

struct MovingBodyOptions {
  std::size_t frames = 400;
  double rate_hz = 100.0;
  double noise_m = 0.0;  ///< Per coordinate.
  /// Deviations of lengths from an average person's, in shares, and of markers from their
  /// landmarks [m].
  double length_share = 0.04;
  double place_m = 0.006;
  unsigned seed = 1;
};

/// Creates some fifty markers on the landmarks of a laboratory's set, moved by slow waves
/// in every joint: arms, legs and trunk move through some forty degrees each.
[[nodiscard]] MovingBody moving_body(const MovingBodyOptions& options = {});

}  // namespace marey::testing
