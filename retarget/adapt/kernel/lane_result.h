// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_solve.h"

namespace marey::retarget {

/// Figures of a solve, in addition to its posture.
template <class F>
struct LaneFigures {
  F iterations{};
  F capped{};   ///< 1: max_iterations ended the solve.
  F balance{};  ///< Error of the centre of mass, in units.
};

/// Returns the count of numbers that store_result() writes: rotations of all joints in
/// their parents, then in the world (4 each), positions (3), the lengths of the errors of
/// the plan's points, and the figures. Lengths are in the body's unit, positions relative
/// to the reference's root.
[[nodiscard]] inline std::size_t result_size(const Plan& plan) {
  return 11 * plan.parent.size() + plan.points.size() + 3;
}

/// Writes the result of a lane. Precondition: spread_posture() was called; errors and
/// `figures` belong to the posture.
template <class F>
void store_result(
    const Plan& plan, LaneFigures<F> figures, int lane, Lanes<F>& s, float* to) {
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
  put(figures.iterations);
  put(figures.capped);
  put(figures.balance);
}

}  // namespace marey::retarget
