// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "core/constraint.h"

namespace marey::edit {

/// Time in which a constraint is fully active, without its fades. May be infinite. [s]
struct FullTime {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// Returns the time in which a constraint is fully active; one that never is has the
/// instant at which it would be.
[[nodiscard]] inline FullTime full_time(const Activation& when) {
  constexpr double kForever_s = std::numeric_limits<double>::infinity();
  FullTime out{-kForever_s, kForever_s};
  if (when.start_s) out.from_s = *when.start_s + when.start_duration_s;
  if (when.stop_s) out.to_s = std::max(*when.stop_s, out.from_s);
  return out;
}

[[nodiscard]] inline bool overlap(const FullTime& a, const FullTime& b) {
  return a.from_s <= b.to_s && b.from_s <= a.to_s;
}

}  // namespace marey::edit
