// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/kernel/lane_loop.h"

namespace marey::retarget {

std::unique_ptr<LaneKernel> make_scalar_kernel(const Plan& plan) {
  return std::make_unique<LaneLoop<float, 1>>(plan);
}

}  // namespace marey::retarget
