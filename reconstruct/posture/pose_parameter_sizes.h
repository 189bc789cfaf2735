// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the sizes of pose parameters as constants of the compiler.

#include <type_traits>

#include <Eigen/Core>

#include "reconstruct/posture/pose_parameters.h"

namespace marey::reconstruct {

template <int N>
using Square = Eigen::Matrix<double, N, N>;

/// Calls `what` with the size of each parameter's unknowns as a constant.
template <class F>
void each_parameter(F&& what) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (tangent_size(parameter) == 3) {
      what(parameter, std::integral_constant<int, 3>());
    } else {
      what(parameter, std::integral_constant<int, 1>());
    }
  }
}

}  // namespace marey::reconstruct
