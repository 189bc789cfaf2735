// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace marey {

/// Returns the element of `values` at the position `share` between the minimum (0) and
/// the maximum (1) in ascending order; the greater one if two are equally near. It is
/// always one of the values, without interpolation: at one half of an even count it is
/// the upper middle one. Takes the values by value, since it reorders them. Linear.
/// Preconditions: not empty, no NaN among them, 0 <= share <= 1.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// Returns quantile() at one half.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace marey
