// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/detail/level_fade.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"

namespace marey::engine {
void LevelFade::advance(const Detail& granted, double step_s) {
  MAREY_ASSERT(step_s > 0.0);
  since_s_ += step_s;
  const bool may_change = since_s_ >= kDetailHold_s - kRounding_s;
  if (granted <= now_) {
    granted_s_ = 0.0;
    if (granted < now_ && may_change) change(granted);
    return;
  }
  risen_ = granted_s_ > 0.0 ? std::min(risen_, granted) : granted;
  granted_s_ += step_s;
  if (may_change && granted_s_ >= kDetailHold_s - kRounding_s) change(risen_);
}

void LevelFade::change(const Detail& to) {
  from_level_ = now_.level;
  // A change of the rate alone has nothing to fade, but is not repeated at once either.
  now_ = to;
  since_s_ = 0.0;
  granted_s_ = 0.0;
}

double LevelFade::activation(int level) const {
  const double before = from_level_ >= level ? 1.0 : 0.0;
  const double after = now_.level >= level ? 1.0 : 0.0;
  if (before == after || !is_fading()) return after;
  const double share = std::min(1.0, smooth_step(since_s_ / kDetailFade_s));
  return before + (after - before) * share;
}

bool LevelFade::is_due(std::uint64_t step, std::uint32_t id) const {
  const auto period = static_cast<std::uint64_t>(period_steps(now_.rate));
  return is_fading() || (step + id) % period == 0;
}

}  // namespace marey::engine
