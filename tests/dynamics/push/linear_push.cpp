// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/dynamics/push/linear_push.h"

#include <cmath>
#include <limits>
#include <utility>

namespace marey::testing {
namespace {

using ConditionRow = std::array<long double, 9>;

/// Returns the condition that a derivative has a value at x.
ConditionRow condition(int order, long double x, long double value) {
  ConditionRow row{};
  for (int k = order; k < 8; ++k) {
    long double factor = 1.0L;
    for (int j = 0; j < order; ++j) factor *= static_cast<long double>(k - j);
    row[static_cast<std::size_t>(k)] = factor * std::pow(x, k - order);
  }
  row[8] = value;
  return row;
}

LinearPush solve_conditions(std::array<ConditionRow, 8> rows) {
  for (std::size_t column = 0; column < 8; ++column) {
    std::size_t pivot = column;
    for (std::size_t r = column; r < 8; ++r)
      if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
    std::swap(rows[column], rows[pivot]);
    for (std::size_t r = 0; r < 8; ++r) {
      if (r == column) continue;
      const long double factor = rows[r][column] / rows[column][column];
      for (std::size_t k = column; k < 9; ++k) rows[r][k] -= factor * rows[column][k];
    }
  }
  LinearPush push{};
  for (std::size_t k = 0; k < 8; ++k) push[k] = rows[k][8] / rows[k][k];
  return push;
}

}  // namespace

LinearPush linear_push(const dynamics::PushEnds& ends,
                       double lowest_at,
                       double lowest_m) {
  const long double t = ends.duration_s;
  return solve_conditions({condition(0, 0.0L, ends.start_m),
                           condition(1, 0.0L, t * ends.start_m_s),
                           condition(2, 0.0L, t * t * ends.start_m_s2.value_or(0.0)),
                           condition(0, 1.0L, ends.end_m),
                           condition(1, 1.0L, t * ends.end_m_s),
                           condition(2, 1.0L, t * t * ends.end_m_s2.value_or(0.0)),
                           condition(0, lowest_at, lowest_m),
                           condition(1, lowest_at, 0.0L)});
}

long double derivative(const LinearPush& push, int order, long double x) {
  long double sum = 0.0L;
  for (int k = 7; k >= order; --k) {
    long double term = push[static_cast<std::size_t>(k)];
    for (int j = 0; j < order; ++j) term *= static_cast<long double>(k - j);
    sum = sum * x + term;
  }
  return sum;
}

SampledHeights sampled_heights(const dynamics::PushEnds& ends,
                               double lowest_at,
                               int instants,
                               bool only_force) {
  constexpr long double kFar = std::numeric_limits<long double>::infinity();
  const LinearPush at_zero = linear_push(ends, lowest_at, 0.0);
  LinearPush per_m = linear_push(ends, lowest_at, 1.0);
  for (std::size_t k = 0; k < 8; ++k) per_m[k] -= at_zero[k];
  SampledHeights heights{-kFar, 0.0L, kFar, 0.0L};
  // constant + height * slope >= 0
  const auto bound = [&](long double constant, long double slope, long double x) {
    const long double height = -constant / slope;
    if (slope > 0.0L && height > heights.low_m) {
      heights.low_m = height;
      heights.low_at = x;
    } else if (slope < 0.0L && height < heights.high_m) {
      heights.high_m = height;
      heights.high_at = x;
    }
  };
  const long double gravity =
      static_cast<long double>(ends.gravity_m_s2) * ends.duration_s * ends.duration_s;
  for (int i = 1; i < instants; ++i) {
    const long double x = static_cast<long double>(i) / instants;
    bound(derivative(at_zero, 2, x) + gravity, derivative(per_m, 2, x), x);
    if (only_force) continue;
    const long double side = x < lowest_at ? -1.0L : 1.0L;
    if (std::abs(x - lowest_at) > 1e-6L)
      bound(side * derivative(at_zero, 1, x), side * derivative(per_m, 1, x), x);
  }
  return heights;
}

}  // namespace marey::testing
