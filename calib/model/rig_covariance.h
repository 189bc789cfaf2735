// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/camera.h"

namespace marey::calib {

/// The joint covariance of all parameters of all cameras of a rig. Cameras that were
/// calibrated from the same sightings have correlated errors.
///
/// Per camera, in this order: Intrinsics::parameters() (zero for terms that the lens does
/// not have and for terms held fixed); the rotation vector, in the world [rad], from the
/// camera's true attitude to the estimated one; its centre in the world [m].
struct RigCovariance {
  static constexpr std::size_t kPerCamera = Intrinsics::kParameterCount + 6;

  std::size_t cameras = 0;
  std::vector<double> values;  ///< Row by row, size() by size().

  [[nodiscard]] std::size_t size() const { return kPerCamera * cameras; }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * size() + column];
  }
};

}  // namespace marey::calib
