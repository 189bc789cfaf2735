// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/sender_clock.h"

#include <cmath>

#include "core/base/assert.h"

namespace marey::live {

double SenderClock::at_s(std::optional<double> sender_s, double arrived_s) {
  MAREY_ASSERT(std::isfinite(arrived_s) && std::isfinite(sender_s.value_or(0.0)));
  const bool is_first = !has_sender_time_;
  if (is_first) has_sender_time_ = sender_s.has_value();
  if (!*has_sender_time_) return arrived_s;
  // A frame without a sender time uses the offset of the last frame.
  if (!sender_s) return arrived_s + ahead_s_;
  ahead_s_ = *sender_s + ours_from_theirs_s_ - arrived_s;
  // Very large times lose the precision of this sum. The negated comparison also catches
  // NaN, so such a result is never used.
  if (is_first || !(std::abs(ahead_s_) <= kMaxOffset_s)) {
    ours_from_theirs_s_ = arrived_s - *sender_s;
    ahead_s_ = 0.0;
  }
  return arrived_s + ahead_s_;
}

}  // namespace marey::live
