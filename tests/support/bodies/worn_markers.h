// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/body.h"
#include "core/marker_tracks.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::testing {

struct MarkerFilm {
  int frames = 200;
  double hz = 100.0;
  double noise_m = 0.0;  ///< Standard deviation of every coordinate; fixed seed.
};

/// Returns the places of the markers of `body` during a movement, every marker in every
/// frame. Frame 1 is at time 0.
[[nodiscard]] MarkerTracks film_markers(const Body& body,
                                        const Movement& movement,
                                        const MarkerFilm& film = {});

}  // namespace marey::testing
