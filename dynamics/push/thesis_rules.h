// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "dynamics/push/push_ends.h"

namespace marey::dynamics {

/// Ends in units of the duration T, with the start as origin of heights: velocities times
/// T, accelerations times T^2. [m]
struct UnitEnds {
  double rise = 0.0;
  double start_velocity = 0.0;
  double end_velocity = 0.0;
  double start_acceleration = 0.0;
  double end_acceleration = 0.0;
  double start_force = 0.0;  ///< Acceleration plus gravity; exactly 0 in free fall.
  double end_force = 0.0;
};

/// Returns the ends with accelerations of at least free fall; nullopt if they are not
/// finite, or if the duration or gravity is not above 0.
[[nodiscard]] std::optional<UnitEnds> unit_ends(const PushEnds& ends);

/// Returns the coefficients of the quintic Hermite polynomial of the ends.
[[nodiscard]] std::array<double, 6> end_quintic(const UnitEnds& ends);

/// The bump x^3 (1 - x)^3 (value + slope (x - s)) that is added to the quintic.
struct HeightBump {
  double value = 0.0;
  double slope = 0.0;
};
/// The bumps by which the polynomial is at rest at x = s, for all heights z of that point
/// above the start: fixed + z * per_m.
struct HeightBumps {
  HeightBump fixed;
  HeightBump per_m;
};
/// Precondition: 0 < s < 1.
[[nodiscard]] HeightBumps bumps_at(const std::array<double, 6>& quintic, double s);

/// One end of an interval of heights while it is found. `side` is +1 for the low end (the
/// largest bound binds) and -1 for the high end.
struct BindingHeight {
  double side = 1.0;
  double height_m = 0.0;  ///< Above the start.
  double at = 0.0;        ///< x at which the rule binds.
  bool of_force = true;
};
/// Both ends of the heights that the rules leave; low above high: empty.
struct RuledHeights {
  BindingHeight low{1.0, -std::numeric_limits<double>::infinity()};
  BindingHeight high{-1.0, std::numeric_limits<double>::infinity()};
  [[nodiscard]] double width_m() const { return high.height_m - low.height_m; }
};
/// Returns the bounds that the rules of allowed_heights() set at x = s; nullopt if a rule
/// fails at every height. Allocates nothing. Precondition: 0 < s < 1.
[[nodiscard]] std::optional<RuledHeights> ruled_heights(const UnitEnds& ends, double s);

}  // namespace marey::dynamics
