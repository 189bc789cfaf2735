// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phase_lock.h"

#include <algorithm>
#include <cmath>

#include "engine/sync/phase_warp.h"

#include "core/base/assert.h"

namespace marey::engine {

void PhaseLock::start(double cycle_s, double speed, const PhaseLockOptions& options) {
  MAREY_ASSERT(cycle_s > 0.0 && speed > 0.0);
  options_ = options;
  cycle_s_ = cycle_s;
  speed_ = speed;
  tempo_hz_ = speed / cycle_s;
  watched_cycles_ = 0.0;
  has_last_ = false;
}

double PhaseLock::step(double now_s, double lead_phase, double follower_phase) {
  if (has_last_ && now_s > last_s_) {
    const double cycles = std::remainder(lead_phase - last_lead_phase_, 1.0);
    // At first the mean of all, then of the last part of a cycle.
    watched_cycles_ += std::abs(cycles);
    const double span = std::min(watched_cycles_, options_.tempo_cycles);
    const double share = span > 0.0 ? std::min(1.0, std::abs(cycles) / span) : 0.0;
    tempo_hz_ += share * (cycles / (now_s - last_s_) - tempo_hz_);
  }
  has_last_ = true;
  last_s_ = now_s;
  last_lead_phase_ = lead_phase;
  const double base = std::clamp(
      tempo_hz_ * cycle_s_, options_.min_rate * speed_, options_.max_rate * speed_);
  const double error = std::remainder(lead_phase - follower_phase, 1.0);
  const double change = std::clamp(
      options_.gain_per_cycle * error, -options_.max_change, options_.max_change);
  return std::clamp(base * (1.0 + change), kMinWarpRate, kMaxWarpRate);
}

}  // namespace marey::engine
