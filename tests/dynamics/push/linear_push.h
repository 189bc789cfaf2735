// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "dynamics/push/push_ends.h"

namespace marey::testing {

/// The polynomial of degree 7 of the thesis' law from its linear system of 8 conditions,
/// by Gaussian elimination in long double. Shares no code with thesis_push(), and does
/// not change the ends. Coefficients of x = t / duration_s, from x^0. [m]
using LinearPush = std::array<long double, 8>;
[[nodiscard]] LinearPush linear_push(const dynamics::PushEnds& ends,
                                     double lowest_at,
                                     double lowest_m);

/// Returns the value of the polynomial's derivative of order 0 to 2 with respect to x.
[[nodiscard]] long double derivative(const LinearPush& push, int order, long double x);

/// Interval of heights that the rules leave at equally spaced instants inside (0, 1), and
/// the x at which each end is bound. low > high: empty.
struct SampledHeights {
  long double low_m = 0.0;
  long double low_at = 0.0;
  long double high_m = 0.0;
  long double high_at = 0.0;
};
/// `only_force`: the force is the only rule.
[[nodiscard]] SampledHeights sampled_heights(const dynamics::PushEnds& ends,
                                             double lowest_at,
                                             int instants,
                                             bool only_force);

}  // namespace marey::testing
