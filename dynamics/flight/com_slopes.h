// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/time.h"

namespace marey::dynamics {

/// Smoothed motion of the centre of mass, one value per frame: the parabola through the
/// frames around each, by least squares.
struct ComSlopes {
  std::vector<double> height_m;  ///< Smoothed.
  std::vector<double> up_m_s;    ///< Vertical velocity.
  std::vector<double> up_m_s2;   ///< Vertical acceleration.
  std::vector<glm::dvec3> velocity_m_s;
};

/// Window over which the parabolas are fitted. [s]
inline constexpr double kSlopeWindow_s = 0.05;

/// Computes them over windows of kSlopeWindow_s, but at least 3 frames. The frames at the
/// ends have the parabola of the nearest whole window. Fewer than 3 frames: all 0, with
/// the heights as they are. Linear in frames. Precondition: rate above 0.
[[nodiscard]] ComSlopes com_slopes(std::span<const glm::dvec3> com_in_world,
                                   FrameRate rate);

}  // namespace marey::dynamics
