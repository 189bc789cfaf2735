// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_solve.h"

namespace marey::retarget {

/// Numbers that store_result() writes: rotations of all joints in their parents, then in
/// the world (4 each), places (3), errors of the plan's points, the centre of mass (3),
/// iterations, mean, worst and balance error. Lengths in the body's unit, places from the
/// reference's root.
[[nodiscard]] inline std::size_t result_size(const Plan& plan) {
  return 11 * plan.parent.size() + plan.points.size() + 7;
}

/// Precondition: spread_posture(), and `errors` are the posture's.
template <class F>
void store_result(
    const Plan& plan, Errors<F> errors, F iterations, int lane, Lanes<F>& s, float* to) {
  const auto put = [&](F& x) { *to++ = static_cast<float>(lane_of(x, lane)); };
  const auto put_rotations = [&](std::vector<Quat<F>>& rotations) {
    for (std::size_t j = 0; j < plan.parent.size(); ++j) {
      put(rotations[j].w);
      put(rotations[j].x);
      put(rotations[j].y);
      put(rotations[j].z);
    }
  };
  put_rotations(s.local);
  put_rotations(s.rotation);
  for (std::size_t j = 0; j < plan.parent.size(); ++j) {
    put(s.place[j].x);
    put(s.place[j].y);
    put(s.place[j].z);
  }
  for (LanePoint<F>& p : s.points) {
    F error = length(p.error);
    put(error);
  }
  put(s.com.x);
  put(s.com.y);
  put(s.com.z);
  put(iterations);
  put(errors.mean);
  put(errors.worst);
  put(errors.balance);
}

}  // namespace marey::retarget
