// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phase_lock.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

TEST(PhaseLock, LocksWithinThreeCyclesAndStaysWhileTheTempoChanges) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const double clip_cycle_s = 0.6 + 0.8 * share(random);
    const double period_s = clip_cycle_s * (0.9 + 0.2 * share(random));
    double lead = share(random);
    double follower_s = clip_cycle_s * share(random);
    PhaseLock lock;
    lock.start(clip_cycle_s, 1.0);
    double tempo_hz = 1.0 / period_s;
    const double start = lead;
    double next_change = start + 3.5;
    const double step_s = 1.0 / 60.0;
    for (int i = 0; i < 1500; ++i) {
      const double follower = follower_s / clip_cycle_s;
      const double error_s = std::remainder(lead - follower, 1.0) / tempo_hz;
      if (lead - start > 3.0) {
        ASSERT_LT(std::abs(error_s), 0.04) << trial;
      }
      const double rate = lock.step(i * step_s, lead - std::floor(lead), follower);
      ASSERT_GE(rate, 0.25);
      ASSERT_LE(rate, 4.0);
      follower_s += rate * step_s;
      lead += tempo_hz * step_s;
      if (lead > next_change) {
        // Between two tempos that are 10 % apart.
        tempo_hz = tempo_hz * period_s > 1.05 ? 1.0 / period_s : 1.1 / period_s;
        next_change = lead + 1.0 + 3.0 * share(random);
      }
    }
  }
}

}  // namespace
}  // namespace marey::engine
