// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "core/camera_quality.h"

namespace marey::app {

/// How well a place that all cameras see is known because of where they are themselves:
/// what is wrong with each of them counts by its share. [m]
[[nodiscard]] inline double common_sigma_m(std::span<const CameraQuality> cameras) {
  double sum_m2 = 0.0;
  for (const CameraQuality& camera : cameras) {
    sum_m2 += camera.centre_sigma_m * camera.centre_sigma_m;
  }
  return cameras.empty() ? 0.0 : std::sqrt(sum_m2) / static_cast<double>(cameras.size());
}

}  // namespace marey::app
