// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/motion.h"
#include "reconstruct/fit_markers.h"

namespace marey::testing {

/// Somebody who moves every joint, with markers on known places.
struct MovingBody {
  Body body;            ///< The truth, markers' places included.
  Motion motion;        ///< Of make_humanoid(body.proportions).
  MarkerTracks tracks;  ///< Exact but for `noise_m`.
  std::vector<reconstruct::NamedMarker> labels;
};

struct MovingBodyOptions {
  std::size_t frames = 400;
  double rate_hz = 100.0;
  double noise_m = 0.0;  ///< Per coordinate.
  /// How far lengths differ from an average person's, in shares, and markers lie from
  /// their landmarks [m].
  double length_share = 0.04;
  double place_m = 0.006;
  unsigned seed = 1;
};

/// Some fifty markers on the landmarks of a laboratory's set, moved by slow waves in
/// every joint: arms, legs and trunk go through some forty degrees each.
[[nodiscard]] MovingBody moving_body(const MovingBodyOptions& options = {});

}  // namespace marey::testing
