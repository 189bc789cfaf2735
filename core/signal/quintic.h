// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey {

/// Value, rate and acceleration at one time. T is a number or a vector.
template <class T>
struct Motion2 {
  T value{};
  T rate{};
  T acceleration{};
};

/// Returns the quintic from `start` at time 0 to `end` at `length_s`, at `time_s` in
/// between: the path of least jerk with these ends. Exact at both ends.
/// Precondition: length_s > 0.
template <class T>
[[nodiscard]] Motion2<T> quintic(const Motion2<T>& start,
                                 const Motion2<T>& end,
                                 double length_s,
                                 double time_s) {
  const double h = length_s;
  const double x = time_s / h;
  // Coefficients over x in [0, 1].
  const T c0 = start.value;
  const T c1 = h * start.rate;
  const T c2 = (0.5 * h * h) * start.acceleration;
  const T d0 = end.value - c0 - c1 - c2;
  const T d1 = h * end.rate - c1 - 2.0 * c2;
  const T d2 = (h * h) * end.acceleration - 2.0 * c2;
  const T c3 = 10.0 * d0 - 4.0 * d1 + 0.5 * d2;
  const T c4 = -15.0 * d0 + 7.0 * d1 - d2;
  const T c5 = 6.0 * d0 - 3.0 * d1 + 0.5 * d2;
  Motion2<T> out;
  out.value = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
  out.rate = (1.0 / h) *
             (c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + (5.0 * x) * c5))));
  out.acceleration =
      (1.0 / (h * h)) * (2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + (20.0 * x) * c5)));
  return out;
}

}  // namespace marey
