// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/sender_clock.h"

#include <cmath>

#include "core/assert.h"

namespace marey::app {

double SenderClock::at_s(std::optional<double> said_s, double arrived_s) {
  MAREY_ASSERT(std::isfinite(arrived_s) && std::isfinite(said_s.value_or(0.0)));
  const bool is_first = !is_told_;
  if (is_first) is_told_ = said_s.has_value();
  if (!*is_told_) return arrived_s;
  // One that forgot its time is where the last one was.
  if (!said_s) return arrived_s + ahead_s_;
  ahead_s_ = *said_s + ours_from_theirs_s_ - arrived_s;
  // Huge numbers have no digits left for this sum: what comes out is not looked at then.
  if (is_first || !(std::abs(ahead_s_) <= kFarthest_s)) {
    ours_from_theirs_s_ = arrived_s - *said_s;
    ahead_s_ = 0.0;
  }
  return arrived_s + ahead_s_;
}

}  // namespace marey::app
