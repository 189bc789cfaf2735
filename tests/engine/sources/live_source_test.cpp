// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sources/live_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/split_mix.h"
#include "tests/engine/made_performer.h"
#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

constexpr double kLiveStep_s = 1.0 / 60.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Largest change of velocity between two steps: limbs and segments, in rad/s.
float largest_change(const PostureRates& a, const PostureRates& b) {
  float worst = 0.0F;
  for (std::size_t i = 0; i < kUsedRotations; ++i) {
    worst = std::max({worst,
                      std::abs(a.x[i] - b.x[i]),
                      std::abs(a.y[i] - b.y[i]),
                      std::abs(a.z[i] - b.z[i])});
  }
  return worst;
}

// Mean angle between two postures. [rad]
double mean_angle_rad(const BlendPosture& a, const BlendPosture& b) {
  const PostureRates turn = rates_between(a, b, 1.0F);
  float sum = 0.0F;
  for (std::size_t i = 0; i < kUsedRotations; ++i) {
    sum +=
        std::sqrt(turn.x[i] * turn.x[i] + turn.y[i] * turn.y[i] + turn.z[i] * turn.z[i]);
  }
  return static_cast<double>(sum) / static_cast<double>(kUsedRotations);
}

LiveSource started(const MadePerformer& performer) {
  LiveSource source;
  EXPECT_TRUE(source.push(performer.at(-kLiveStep_s)));
  EXPECT_TRUE(source.push(performer.at(0.0)));
  source.step(0.0, kLiveStep_s);
  return source;
}

TEST(LiveSource, ShowsTheNewestPostureInItsStep) {
  const MadePerformer performer;
  LiveSource source = started(performer);
  RootPlace root = performer.at(0.0).root_legs;
  for (int step = 1; step < 200; ++step) {
    const LivePosture truth = performer.at(step * kLiveStep_s);
    ASSERT_TRUE(source.push(truth));
    source.step(truth.time_s, kLiveStep_s);
    BlendPosture shown;
    source.sample(truth.time_s, shown);
    ASSERT_TRUE(shown == truth.posture);
    root = moved(root, source.root_step(truth.time_s - kLiveStep_s, truth.time_s));
    EXPECT_NEAR(root.z_m, truth.root_legs.z_m, 1e-9);
    EXPECT_EQ(source.bears(), truth.bears);
  }
}

TEST(LiveSource, PredictsByTheAgeOfSlowData) {
  // 30 Hz with a random delay of up to 20 ms: the error of a forecast, not a delay.
  const MadePerformer performer;
  LiveSource source = started(performer);
  SplitMix random(5);
  double next_data_s = 1.0 / 30.0;
  double sum = 0.0;
  double sum_held = 0.0;
  BlendPosture newest = performer.at(0.0).posture;
  for (int step = 1; step < 300; ++step) {
    const double time_s = step * kLiveStep_s;
    while (next_data_s <= time_s - 0.02 * random.unit()) {
      ASSERT_TRUE(source.push(performer.at(next_data_s)));
      newest = performer.at(next_data_s).posture;
      next_data_s += 1.0 / 30.0;
    }
    source.step(time_s, kLiveStep_s);
    BlendPosture shown;
    source.sample(time_s, shown);
    const BlendPosture now = performer.at(time_s).posture;
    sum += mean_angle_rad(shown, now);
    sum_held += mean_angle_rad(newest, now);
  }
  EXPECT_LT(sum, sum_held * 0.8);
}

TEST(LiveSource, LosesVelocityByHalfIn150Milliseconds) {
  const MadePerformer performer;
  LiveSource source = started(performer);
  BlendPosture before;
  BlendPosture now;
  source.sample(0.0, before);
  double first = 0.0;
  for (int step = 1; step <= 60; ++step) {
    const double time_s = step * kLiveStep_s;
    source.step(time_s, kLiveStep_s);
    source.sample(time_s, now);
    const auto speed = static_cast<double>(
        largest_change(rates_between(before, now, static_cast<float>(kLiveStep_s)), {}));
    before = now;
    if (step == 1) first = speed;
    const double expected = first * std::exp2(-(step - 1) * kLiveStep_s / 0.15);
    EXPECT_NEAR(speed, expected, 0.02 * first) << step;
    EXPECT_EQ(source.report().is_lost, time_s > 0.1) << step;
  }
  for (const float share : source.report().share) EXPECT_LT(share, 0.03F);
}

TEST(LiveSource, BringsAGroupBackAfterGoodData) {
  const MadePerformer performer;
  LiveSource source = started(performer);
  const std::size_t arm = static_cast<std::size_t>(EditGroup::kLeftArm);
  const std::size_t head = static_cast<std::size_t>(EditGroup::kHead);
  float before = 1.0F;
  float change_before = 0.0F;
  for (int step = 1; step < 200; ++step) {
    LivePosture posture = performer.at(step * kLiveStep_s);
    if (step >= 10 && step < 60) posture.sigma_m[arm] = 0.06F;
    ASSERT_TRUE(source.push(posture));
    source.step(posture.time_s, kLiveStep_s);
    const float share = source.report().share[arm];
    EXPECT_EQ(source.report().share[head], 1.0F);
    // The slope of the share changes by at most 60 ms of a full change in a step.
    EXPECT_LT(std::abs(share - before - change_before), 0.03F) << step;
    change_before = share - before;
    before = share;
    if (step == 59 || step == 60 + 16) {
      EXPECT_LT(share, 0.03F);
    }
    if (step == 60 + 18 + 40) {
      EXPECT_GT(share, 0.97F);
    }
  }
}

TEST(LiveSource, MeetsDataAfterGapsWithoutPops) {
  const MadePerformer performer;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SplitMix random(seed);
    LiveSource source = started(performer);
    float worst = 0.0F;
    float worst_own = 0.0F;
    int missing = 0;
    BlendPosture shown;
    source.sample(0.0, shown);
    PostureRates rates = rates_between(
        performer.at(-kLiveStep_s).posture, shown, static_cast<float>(kLiveStep_s));
    PostureRates own = rates;
    for (int step = 1; step < 400; ++step) {
      const double time_s = step * kLiveStep_s;
      if (missing == 0 && random.unit() < 0.02) {
        missing = 4 + static_cast<int>(40 * random.unit());
      }
      if (missing > 0) {
        --missing;
      } else {
        ASSERT_TRUE(source.push(performer.at(time_s)));
      }
      source.step(time_s, kLiveStep_s);
      const BlendPosture before = shown;
      source.sample(time_s, shown);
      const auto step_s = static_cast<float>(kLiveStep_s);
      const PostureRates now = rates_between(before, shown, step_s);
      worst = std::max(worst, largest_change(now, rates));
      rates = now;
      const PostureRates own_now =
          rates_between(performer.at(time_s - kLiveStep_s).posture,
                        performer.at(time_s).posture,
                        step_s);
      worst_own = std::max(worst_own, largest_change(own_now, own));
      own = own_now;
    }
    EXPECT_LT(worst, 2.5F * worst_own) << seed;
  }
}

TEST(LiveSource, RefusesBadData) {
  const MadePerformer performer;
  LiveSource source = started(performer);
  EXPECT_FALSE(source.push(performer.at(0.0)));
  EXPECT_FALSE(source.push(performer.at(-1.0)));
  const auto refuses = [&](auto&& spoil) {
    LivePosture bad = performer.at(1.0);
    spoil(bad);
    return !source.push(bad);
  };
  const auto nan = static_cast<float>(kNaN);
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.time_s = kNaN; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.root_legs.heading_rad = kNaN; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.posture.x[7] = nan; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.posture.w[3] += 0.1F; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.posture.mid_y[2] = nan; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.posture.fold_rad[0] = -0.1F; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.posture.height_legs = nan; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.sigma_m[1] = -1.0F; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.sigma_m[1] = nan; }));
  EXPECT_TRUE(refuses([&](LivePosture& p) { p.bears = 16; }));
  // Refused postures leave no trace.
  EXPECT_TRUE(source.push(performer.at(kLiveStep_s)));
  source.step(kLiveStep_s, kLiveStep_s);
  BlendPosture shown;
  source.sample(kLiveStep_s, shown);
  EXPECT_TRUE(shown == performer.at(kLiveStep_s).posture);
}

TEST(LiveSource, RefusesBadOptions) {
  EXPECT_TRUE(check_live_options({}));
  EXPECT_FALSE(check_live_options({.max_sigma_m = 0.0}));
  EXPECT_FALSE(check_live_options({.good_s = kNaN}));
}

TEST(LiveSource, AllocatesNothing) {
  const MadePerformer performer;
  LiveSource source = started(performer);
  const long before = testing::allocations();
  for (int step = 1; step < 60; ++step) {
    if (step < 20 || step > 40) {
      if (!source.push(performer.at(step * kLiveStep_s))) FAIL();
    }
    source.step(step * kLiveStep_s, kLiveStep_s);
  }
  EXPECT_EQ(testing::allocations(), before);
}

}  // namespace
}  // namespace marey::engine
