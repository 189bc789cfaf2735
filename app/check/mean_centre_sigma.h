// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "core/camera_quality.h"

namespace marey::app {

/// Returns the part of the sigma of a point that all cameras see which is caused by the
/// sigmas of the camera centres: their root sum of squares divided by the number of
/// cameras. [m]
[[nodiscard]] inline double mean_centre_sigma_m(std::span<const CameraQuality> cameras) {
  double sum_m2 = 0.0;
  for (const CameraQuality& camera : cameras) {
    sum_m2 += camera.centre_sigma_m * camera.centre_sigma_m;
  }
  return cameras.empty() ? 0.0 : std::sqrt(sum_m2) / static_cast<double>(cameras.size());
}

}  // namespace marey::app
