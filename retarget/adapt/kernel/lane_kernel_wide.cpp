// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <xsimd/xsimd.hpp>

#include "retarget/adapt/kernel/lane_loop.h"

namespace marey::retarget {

std::unique_ptr<LaneKernel> make_wide_kernel(const Plan& plan) {
#if defined(__AVX2__)
  using Batch = xsimd::batch<float, xsimd::avx2>;
  return std::make_unique<LaneLoop<Batch, 8>>(plan);
#else
  static_cast<void>(plan);
  return nullptr;
#endif
}

}  // namespace marey::retarget
