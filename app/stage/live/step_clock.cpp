// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/step_clock.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::app {

StepClock::StepClock(double rate_hz, int max_catch_up)
    : period_ns_(1e9 / rate_hz), max_catch_up_(max_catch_up) {
  MAREY_ASSERT(rate_hz > 0.0 && max_catch_up >= 1);
}

void StepClock::start(Timestamp now) {
  start_ = now;
  done_ = 0;
}

Timestamp StepClock::due(std::int64_t step) const {
  return start_ + Timestamp(std::llround(static_cast<double>(step) * period_ns_));
}

Timestamp StepClock::next(int steps) const {
  return due(done_ + steps);
}

int StepClock::take_due(Timestamp now) {
  if (now < next()) return 0;
  auto step =
      static_cast<std::int64_t>(static_cast<double>((now - start_).count()) / period_ns_);
  // The division rounds otherwise than due().
  while (due(step) > now) --step;
  while (due(step + 1) <= now) ++step;
  const std::int64_t count =
      std::min<std::int64_t>(step - done_, std::int64_t{max_catch_up_});
  skipped_ += step - done_ - count;
  done_ = step;
  return static_cast<int>(count);
}

}  // namespace marey::app
