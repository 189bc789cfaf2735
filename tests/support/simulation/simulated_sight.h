// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/detection.h"
#include "tests/support/simulation/simulated_tags.h"

namespace marey::testing {

/// A person with tags who moves before cameras.
struct SimulatedScene {
  const SimulatedBody* body = nullptr;  ///< Borrowed, as all here.
  const std::vector<SoftTissuePart>* soft_tissue = nullptr;
  const std::vector<GluedTag>* tags = nullptr;
  Attitude reference{};  ///< The posture in which no tag slides.
};

/// Recording conditions of a trial.
struct SimulatedFilm {
  std::string name;  ///< Folder in the videos' names.
  double hz = 30.0;
  int frames = 0;
  std::vector<double> offsets_s;  ///< Per camera: frame k is exposed at k / hz + this.
  double exposure_s = 0.008;
  double sigma_factor = 1.0;  ///< Claimed noise of corners over the true one.
};

/// Returns the cameras' detections. They follow docs/accuracy/tags.md
/// and "Plans". The chance of reading a tag falls with a shorter edge, a larger angle and
/// more motion blur. Corners err by 0.08 to 0.10 px; 3 % of the variance is common to all
/// sightings of a tag by one camera. Soft tissue hides tags. Sightings drop out at random
/// and in bursts. One in ten thousand is followed by a tag that is not there.
[[nodiscard]] std::vector<CameraDetections> film(const SimulatedScene& scene,
                                                 const Exercise& exercise,
                                                 const std::vector<Camera>& cameras,
                                                 const SimulatedFilm& film,
                                                 Dice& dice);

}  // namespace marey::testing
