// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace marey::engine {

struct RateRange {
  double min = 0.0;
  double max = 0.0;
};

/// Returns the exact range of the rate of a quintic c0 + c1 x + ... + c5 x^5 over x in
/// [0, 1], an interval of `length_s`: at its ends and at the roots of the acceleration,
/// which are separated by those of the acceleration's derivative.
[[nodiscard]] RateRange rate_range(const std::array<double, 6>& c, double length_s);

}  // namespace marey::engine
