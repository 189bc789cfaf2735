// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::testing {

/// A reported place of a joint, with its time.
struct TimedPlace {
  double time_s = 0.0;
  glm::dvec3 p_in_world{0.0};
};

/// Returns the delay of reported joints against their truth [s]: the shift of the truth
/// that fits them best, without each joint's mean error. Depends on no tracker.
/// `joints` holds one list for each joint; `truth` is where that joint was at a time.
/// Shifts of up to 60 ms are found, to some microseconds.
[[nodiscard]] double delay_s(
    std::span<const std::vector<TimedPlace>> joints,
    const std::function<glm::dvec3(std::size_t joint, double time_s)>& truth);

}  // namespace marey::testing
