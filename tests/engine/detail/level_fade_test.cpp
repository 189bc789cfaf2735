// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/detail/level_fade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

constexpr double kStep_s = 1.0 / 60.0;
constexpr Detail kLow{0, DetailRate::kFull};
constexpr Detail kKinetic{2, DetailRate::kFull};

std::array<double, 3> activations(const LevelFade& fade) {
  return {fade.supports(), fade.balance(), fade.dynamics()};
}

TEST(LevelFade, RisesAfterHalfASecondAndFadesInAFifth) {
  LevelFade fade(kLow);
  int steps = 0;
  while (fade.detail() == kLow) {
    fade.advance(kKinetic, kStep_s);
    ++steps;
  }
  EXPECT_EQ(steps, 30);
  EXPECT_EQ(fade.detail(), kKinetic);
  EXPECT_EQ(fade.supports(), 0.0);
  for (int i = 0; i < 12; ++i) fade.advance(kKinetic, kStep_s);
  EXPECT_FALSE(fade.is_fading());
  EXPECT_EQ(activations(fade), (std::array{1.0, 1.0, 0.0}));
}

TEST(LevelFade, FallsAtOnceButKeepsTheLevelUntilItHasFaded) {
  LevelFade fade(kKinetic);
  fade.advance(kLow, kStep_s);
  EXPECT_EQ(fade.detail(), kLow);
  EXPECT_EQ(fade.computed_level(), 2);
  EXPECT_EQ(fade.supports(), 1.0);
  for (int i = 0; i < 12; ++i) fade.advance(kLow, kStep_s);
  EXPECT_EQ(fade.computed_level(), 0);
  EXPECT_EQ(activations(fade), (std::array{0.0, 0.0, 0.0}));
}

TEST(LevelFade, AWishOfLessThanHalfASecondChangesNothing) {
  LevelFade fade(kLow);
  for (int n = 0; n < 1000; ++n) fade.advance(n % 29 == 0 ? kLow : kKinetic, kStep_s);
  EXPECT_EQ(fade.detail(), kLow);
}

TEST(LevelFade, TheLowestWishOfTheTimeIsTaken) {
  LevelFade fade(kLow);
  const Detail kinematic{1, DetailRate::kHalf};
  for (int n = 0; n < 30; ++n) fade.advance(n == 7 ? kinematic : kKinetic, kStep_s);
  EXPECT_EQ(fade.detail(), kinematic);
}

TEST(LevelFade, AChangeOfTheRateAloneFadesNothing) {
  LevelFade fade(kKinetic);
  fade.advance({2, DetailRate::kQuarter}, kStep_s);
  EXPECT_EQ(fade.detail().rate, DetailRate::kQuarter);
  EXPECT_EQ(activations(fade), (std::array{1.0, 1.0, 0.0}));
}

TEST(LevelFade, NeverPopsWhateverIsGranted) {
  // smooth_step's largest slope is 15/8, its largest curvature 10 / sqrt(3).
  constexpr double kMaxSpeed = 1.875 / kDetailFade_s;
  constexpr double kMaxCurvature = 5.7736 / (kDetailFade_s * kDetailFade_s);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    const double step_s = 1.0 / static_cast<double>(30 + random() % 100);
    LevelFade fade({static_cast<std::uint8_t>(random() % 4), DetailRate::kFull});
    std::array<double, 3> before = activations(fade);
    std::array<double, 3> speed_before{};
    double since_change_s = 10.0;
    Detail wish = fade.detail();
    for (int n = 0; n < 1000; ++n) {
      if (random() % 20 == 0) {
        wish = {static_cast<std::uint8_t>(random() % 4),
                static_cast<DetailRate>(random() % 3)};
      }
      const Detail was = fade.detail();
      fade.advance(wish, step_s);
      since_change_s += step_s;
      if (fade.detail() != was) {
        EXPECT_GE(since_change_s, kDetailHold_s - 1e-6);
        since_change_s = 0.0;
      }
      const std::array<double, 3> now = activations(fade);
      for (std::size_t k = 0; k < now.size(); ++k) {
        const double speed = (now[k] - before[k]) / step_s;
        EXPECT_LE(std::abs(speed), kMaxSpeed + 1e-6);
        EXPECT_LE(std::abs(speed - speed_before[k]) / step_s, kMaxCurvature * 1.001);
        EXPECT_TRUE(now[k] >= 0.0 && now[k] <= 1.0);
        speed_before[k] = speed;
        // A stage that bears on the posture is computed.
        if (now[k] > 0.0) {
          EXPECT_GE(fade.computed_level(), static_cast<int>(k) + 1);
        }
      }
      before = now;
    }
  }
}

TEST(LevelFade, TheCostStaysInTheBudgetUnlessItFell) {
  Result<DetailBudget> made = DetailBudget::make();
  ASSERT_TRUE(made);
  DetailBudget& budget = *made;
  std::mt19937_64 random(5);
  constexpr std::size_t kCharacters = 30;
  std::vector<DetailRequest> requests(kCharacters);
  std::vector<Detail> granted(kCharacters);
  std::vector<LevelFade> fades(kCharacters);
  double least_budget = 0.0;
  std::vector<double> budgets;
  for (int n = 0; n < 2000; ++n) {
    for (std::size_t i = 0; i < kCharacters; ++i) {
      requests[i].id = static_cast<std::uint32_t>(i);
      requests[i].importance = 1.0 + std::sin(0.01 * n + static_cast<double>(i));
    }
    if (n % 100 == 0) least_budget = static_cast<double>(40 + random() % 200);
    budgets.push_back(least_budget);
    budget.distribute(requests, least_budget, granted);
    double cost = 0.0;
    bool all_settled = true;
    for (std::size_t i = 0; i < kCharacters; ++i) {
      fades[i].advance(granted[i], kStep_s);
      all_settled = all_settled && fades[i].detail() <= granted[i];
      cost += budget.cost_units(fades[i].detail());
    }
    if (all_settled) {
      EXPECT_LE(cost, least_budget + 1e-9) << n;
    }
  }
}

TEST(LevelFade, StepsOfARateAreSpreadOverCharacters) {
  LevelFade fade({1, DetailRate::kQuarter});
  for (std::uint64_t step = 0; step < 16; ++step) {
    int due = 0;
    for (std::uint32_t id = 0; id < 8; ++id) due += fade.is_due(step, id) ? 1 : 0;
    EXPECT_EQ(due, 2);
  }
  const LevelFade full(kKinetic);
  EXPECT_TRUE(full.is_due(3, 1));
}

}  // namespace
}  // namespace marey::engine
