// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion.h"

namespace marey::library {

/// Returns a motion of random postures that change smoothly, on an average adult.
[[nodiscard]] Motion random_motion(std::uint64_t seed, int frames, double hz);

/// Returns the motion turned about the vertical through the origin, positive from +Z to
/// +X, and then moved on the floor.
[[nodiscard]] Motion moved(Motion motion, double turn_rad, double x_m, double z_m);

/// Returns the motion of a body `factor` times as large, on paths as much larger.
[[nodiscard]] Motion scaled(Motion motion, double factor);

/// Returns the motion reflected in the plane X = 0, left and right exchanged.
/// Precondition: identity rest rotations.
[[nodiscard]] Motion reflected(Motion motion);

/// Returns random rows of features: smooth paths in 57 columns, the rest 0.
[[nodiscard]] std::vector<float> random_rows(std::uint64_t seed, int rows);

}  // namespace marey::library
