// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/lane_dispatch.h"

#include "retarget/adapt/kernel/lane_kernel.h"

namespace marey::retarget {

bool has_lanes(LaneWidth width) {
#if defined(__x86_64__)
  switch (width) {
    case LaneWidth::kOne:
    case LaneWidth::kFour:
      return true;
    case LaneWidth::kEight:
      return __builtin_cpu_supports("avx2") != 0;
    case LaneWidth::kSixteen:
      return __builtin_cpu_supports("avx512f") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return width == LaneWidth::kOne;
}

LaneWidth max_lanes() {
  for (const LaneWidth width :
       {LaneWidth::kSixteen, LaneWidth::kEight, LaneWidth::kFour}) {
    if (has_lanes(width)) return width;
  }
  return LaneWidth::kOne;
}

std::unique_ptr<LaneKernel> make_lane_kernel(LaneWidth width, const Plan& plan) {
  switch (width) {
    case LaneWidth::kOne:
      break;
    case LaneWidth::kFour:
      return make_narrow_kernel(plan);
    case LaneWidth::kEight:
      return make_wide_kernel(plan);
    case LaneWidth::kSixteen:
      return make_widest_kernel(plan);
  }
  return make_scalar_kernel(plan);
}

}  // namespace marey::retarget
