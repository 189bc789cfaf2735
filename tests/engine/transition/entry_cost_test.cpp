// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/entry_cost.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/engine/blend/blend_truth.h"

namespace marey::engine {
namespace {

Rig plain_rig() {
  Rig rig;
  rig.leg_length_m = 0.9;
  rig.hip_from_hips_legs = {glm::dvec3(0.1, -0.05, 0.0), glm::dvec3(-0.1, -0.05, 0.0)};
  rig.leg_legs = {1.0, 1.0};
  rig.neck_from_hips_legs = {0.0, 0.6, 0.0};
  rig.shoulder_from_neck_legs = {glm::dvec3(0.2, 0.0, 0.0), glm::dvec3(-0.2, 0.0, 0.0)};
  rig.arm_legs = {0.6, 0.6};
  rig.head_from_neck_legs = {0.0, 0.15, 0.0};
  return rig;
}

// Only the height differs, so that all six points have the same offset along Y, in one
// direction: there the closed form is the integral of its magnitude.
TEST(EntryCost, IsTheAreaUnderTheDecayingOffset) {
  std::mt19937 random(1);
  const BlendPosture from = random_postures(random, 1, 1.0)[0];
  BlendPosture to = from;
  to.height_legs -= 0.2F;
  PostureRates rates;
  rates.height = 0.5F;
  const double y = 2.0 * std::numbers::ln2 / 0.1;
  const double x = 0.2 * 0.9;
  const double v = 0.5 * 0.9;
  double area_m_s = 0.0;
  constexpr double kStep_s = 1e-5;
  for (int i = 0; i < 300000; ++i) {
    const double t = (i + 0.5) * kStep_s;
    area_m_s += kStep_s * std::abs((x + (v + x * y) * t) * std::exp(-y * t));
  }
  EXPECT_NEAR(entry_cost(plain_rig(), from, rates, to, {}), 6.0 * area_m_s, 1e-4);
}

TEST(EntryCost, IsZeroForOnePostureAndInfiniteForOppositeSupports) {
  std::mt19937 random(2);
  const BlendPosture p = random_postures(random, 1, 1.0)[0];
  EXPECT_EQ(entry_cost(plain_rig(), p, {}, p, {}), 0.0);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(entry_cost(plain_rig(), p, {}, p, {}, 0.1, 1U, 8U), kInfinite);
  EXPECT_EQ(entry_cost(plain_rig(), p, {}, p, {}, 0.1, 3U, 7U), 0.0);
  EXPECT_EQ(entry_cost(plain_rig(), p, {}, p, {}, 0.1, 0U, 12U), 0.0);
}

MotionClip random_clip(std::mt19937& random, bool loops) {
  MotionClip clip;
  clip.rate_hz = 30.0F;
  clip.frames = random_postures(random, 24, 1.2);
  clip.frames.push_back(clip.frames.front());
  clip.path.resize(clip.frames.size());
  clip.loops = loops;
  clip.contacts[0] = {{0.0F, 0.38F}};
  clip.contacts[2] = {{0.38F, 0.8F}};
  return clip;
}

PostureRates central_rates(const MotionClip& clip, std::size_t i) {
  const std::size_t last = clip.frames.size() - 1;
  if (clip.loops) {
    const std::size_t before = i == 0 ? last - 1 : i - 1;
    return rates_between(clip.frames[before], clip.frames[i + 1], 2.0F / clip.rate_hz);
  }
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = i == last ? last : i + 1;
  return rates_between(clip.frames[before],
                       clip.frames[after],
                       static_cast<float>(after - before) / clip.rate_hz);
}

TEST(BestEntry, EqualsTheBestOfAllFramesInReach) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const bool loops = seed % 2 == 0;
    const bool anywhere = loops && seed % 3 == 0;
    const MotionClip clip = random_clip(random, loops);
    const BlendPosture from = random_postures(random, 1, 1.0)[0];
    const double at_s = random_in(random, 0.0, 0.8);
    const unsigned bearing = 1U;
    double best = std::numeric_limits<double>::infinity();
    double best_s = -1.0;
    const std::size_t count = clip.frames.size() - (loops ? 1 : 0);
    for (std::size_t i = 0; i < count; ++i) {
      const double time_s = static_cast<double>(i) / 30.0;
      double away_s = std::abs(time_s - at_s);
      if (loops) away_s = std::min(away_s, clip.duration_s() - away_s);
      if ((!anywhere && away_s > 0.45) || time_s > 0.38) continue;
      const double cost =
          entry_cost(plain_rig(), from, {}, clip.frames[i], central_rates(clip, i));
      if (cost < best) {
        best = cost;
        best_s = time_s;
      }
    }
    ASSERT_GE(best_s, 0.0);
    EXPECT_EQ(best_entry_s(plain_rig(), from, {}, bearing, clip, at_s, 0.45, anywhere),
              best_s)
        << seed;
  }
}

TEST(BestEntry, TakesOppositeSupportsIfThereAreNoOthers) {
  std::mt19937 random(4);
  MotionClip clip = random_clip(random, false);
  clip.contacts[0] = {{0.0F, 1.0F}};
  clip.contacts[2].clear();
  const double entry_s = best_entry_s(
      plain_rig(), clip.frames[5], central_rates(clip, 5), 12U, clip, 0.2, 0.3, false);
  EXPECT_NEAR(entry_s, 5.0 / 30.0, 1e-6);
}

}  // namespace
}  // namespace marey::engine
