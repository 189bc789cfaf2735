// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace marey {

/// The one of `values` that lies `share` of the way from the least (0) to the greatest
/// (1) in ascending order, the greater where two are as near. Always one of the values,
/// never between two: of an even count, the upper middle one is at one half. Takes the
/// values by value, since it reorders them. Linear. Preconditions: not empty, no NaN
/// among them, 0 <= share <= 1.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// quantile() at one half.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace marey
