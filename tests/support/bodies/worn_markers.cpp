// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/worn_markers.h"

#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {

MarkerTracks film_markers(const Body& body,
                          const Movement& movement,
                          const MarkerFilm& film) {
  MarkerTracks tracks;
  tracks.rate.hz = film.hz;
  for (const PlacedMarker& marker : body.markers) tracks.labels.push_back(marker.label);
  const Skeleton skeleton = make_humanoid(body.proportions);
  Dice dice(1873);
  for (int f = 0; f < film.frames; ++f) {
    const auto world_from_bone = world_from_joints(skeleton, movement(f / film.hz));
    for (const PlacedMarker& marker : body.markers) {
      MarkerSample sample;
      sample.p_in_world = world_from_bone[index(marker.segment)] * marker.p_in_segment;
      for (int axis = 0; axis < 3 && film.noise_m > 0.0; ++axis) {
        sample.p_in_world[axis] += dice.noise(film.noise_m);
      }
      tracks.samples.emplace_back(sample);
    }
  }
  return tracks;
}

}  // namespace marey::testing
