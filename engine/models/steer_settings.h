// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::engine {

/// Limits of a steered course.
struct SteerSettings {
  double max_turn_rad = 0.610865238198015;    ///< Per step: 35 degrees. In (0, 1.5].
  double max_turn_rad_s = 2.094395102393195;  ///< 120 degrees/s. > 0.
  double min_scale = 0.7;                     ///< For a step's length; in (0, 1].
  double max_scale = 1.3;                     ///< In [1, 2).
  /// A new goal does not change the swing that ends within this time. [s]
  double keep_s = 0.15;
  double max_duration_s = 60.0;  ///< A course may last this long.
  /// Distance that the root still moves after the last landing, along its travel, until
  /// the motion that follows (stop, idle) stands. [m]
  double stop_m = 0.0;
};

/// Maximum turn of a step whose turn may last this long: within both limits.
[[nodiscard]] double max_turn_of_step(const SteerSettings& settings, double turn_s);

}  // namespace marey::engine
