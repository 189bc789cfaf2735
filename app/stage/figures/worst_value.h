// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace marey::app {

/// The worst of the values of one figure, with its time.
struct WorstValue {
  double value = 0.0;
  double time_s = 0.0;    ///< On the clock of the scene.
  std::size_t count = 0;  ///< Number of values; 0: nothing was measured.

  /// Adds a value whose size is an error.
  void add(double new_value, double at_s) {
    if (count++ == 0 || new_value > value) set(new_value, at_s);
  }
  /// Adds a value that is to be large.
  void add_smallest(double new_value, double at_s) {
    if (count++ == 0 || new_value < value) set(new_value, at_s);
  }

 private:
  void set(double new_value, double at_s) {
    value = new_value;
    time_s = at_s;
  }
};

}  // namespace marey::app
