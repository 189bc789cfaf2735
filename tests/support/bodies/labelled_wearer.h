// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::testing {

/// A label and the name of the landmark that its marker is glued to.
struct WornLabel {
  std::string label;
  std::string landmark;
};

/// Place of a landmark on an average body, and its spread between people.
struct WornPlace {
  HumanBone segment{};
  glm::dvec3 p_in_segment_per_stature{0.0};
  double sigma_per_stature = 0.0;
};
using PlaceOf = std::function<WornPlace(const std::string& landmark)>;

/// A simulated person with labelled markers, and trials of it.
struct LabelledWearer {
  Body person;  ///< The truth; its markers are where they were glued.
  std::vector<WornLabel> labels;
  std::vector<MarkerTracks> trials;  ///< Standing, range of motion, walking.
  std::vector<Movement> movements;
};

/// Draws one by `seed`, with landmarks where `place_of` has them: a stature of 1.5
/// to 1.95 m, legs, trunk and arms 3 % longer or shorter than average ones (standard
/// deviation), Plug-in Gait's markers and those inside of knees and ankles, glued by
/// hands that miss by as much as people do; noise of 0.3 to 1.5 mm, skin that slides by 2
/// to 8 mm, and samples that are missing.
[[nodiscard]] LabelledWearer wearer(int seed, const PlaceOf& place_of);

/// Exchanges two labels of a trial. Precondition: it has both.
void exchange(MarkerTracks& tracks, const std::string& a, const std::string& b);

/// Multiplies all coordinates of a trial by a factor.
void rescale(MarkerTracks& tracks, double factor);

}  // namespace marey::testing
