// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/blend_postures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/blend/mean_rotation.h"
#include <gtest/gtest.h>

#include "tests/engine/blend/blend_truth.h"

namespace marey::engine {
namespace {

constexpr double kSpread_rad = 120.0 * std::numbers::pi / 180.0;

PerGroup equal_weights(float weight) {
  PerGroup weights;
  weights.fill(weight);
  return weights;
}

PerGroup random_group_weights(std::mt19937& random) {
  PerGroup weights;
  for (float& weight : weights) weight = static_cast<float>(random_in(random, 0.01, 2.0));
  return weights;
}

BlendPosture blended(const std::vector<BlendPosture>& postures,
                     const std::vector<PerGroup>& weights,
                     BlendSides* sides = nullptr) {
  std::vector<const BlendPosture*> sources;
  for (const BlendPosture& posture : postures) sources.push_back(&posture);
  BlendPosture out;
  blend_postures(sources, weights, sides, out);
  return out;
}

TEST(Interpolate, IsSlerpOnTheShorterArcAndExactAtBothEnds) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const auto frames = random_postures(random, 2, 0.5 * kSpread_rad);
    const auto at = static_cast<float>(random_in(random, 0.0, 1.0));
    BlendPosture out;
    interpolate(frames[0], frames[1], at, out);
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      const glm::dquat a = rotation_in(frames[0], i);
      const glm::dvec3 log = log_of(glm::conjugate(a) * rotation_in(frames[1], i));
      const glm::dquat truth = a * exp_of(static_cast<double>(at) * log);
      EXPECT_LT(angle_between_rad(rotation_in(out, i), truth), 1e-6);
    }
    interpolate(frames[0], frames[1], 0.0F, out);
    EXPECT_EQ(out, frames[0]);
    interpolate(frames[0], frames[1], 1.0F, out);
    EXPECT_EQ(out, frames[1]);
  }
}

TEST(BlendPostures, LeavesSourcesOfWholeWeightToTheBit) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto p = random_postures(random, 3, kSpread_rad);
    const PerGroup some = random_group_weights(random);
    const PerGroup none = equal_weights(0.0F);
    EXPECT_EQ(blended({p[0]}, {some}), p[0]);
    EXPECT_EQ(blended({p[0], p[1]}, {some, none}), p[0]);
    EXPECT_EQ(blended({p[0], p[1]}, {none, some}), p[1]);
    EXPECT_EQ(blended({p[0], p[1], p[2]}, {none, none, some}), p[2]);
  }
}

TEST(BlendPostures, KeepsAGroupOfOneSourceToTheBit) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const std::size_t count = 2 + seed % 3;
    const auto postures = random_postures(random, count, kSpread_rad);
    std::vector<PerGroup> weights;
    for (std::size_t i = 0; i < count; ++i)
      weights.push_back(random_group_weights(random));
    const std::size_t group = seed % kGroupCount;
    for (std::size_t i = 1; i < count; ++i) weights[i][group] = 0.0F;
    const BlendPosture out = blended(postures, weights);
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      if (group_of_rotation()[i] != group) continue;
      EXPECT_EQ(out.x[i], postures[0].x[i]);
      EXPECT_EQ(out.w[i], postures[0].w[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (group_of_limb()[i] != group) continue;
      EXPECT_EQ(out.fold_rad[i], postures[0].fold_rad[i]);
      EXPECT_EQ(out.upper_twist_rad[i], postures[0].upper_twist_rad[i]);
    }
  }
}

TEST(BlendPostures, KeepsAGroupWithoutWeight) {
  std::mt19937 random(3);
  const auto p = random_postures(random, 4, kSpread_rad);
  PerGroup weights = equal_weights(0.5F);
  weights[static_cast<std::size_t>(EditGroup::kRoot)] = 0.0F;
  for (const std::size_t count : {1U, 2U, 3U}) {
    BlendPosture out = p[3];
    const std::array<const BlendPosture*, 3> sources{&p[0], &p[1], &p[2]};
    const std::array<PerGroup, 3> all{weights, weights, weights};
    blend_postures(
        std::span(sources).first(count), std::span(all).first(count), nullptr, out);
    EXPECT_EQ(out.height_legs, p[3].height_legs);
    EXPECT_EQ(out.y[kSegmentRotation], p[3].y[kSegmentRotation]);
    EXPECT_NE(out.fold_rad[0], p[3].fold_rad[0]);
  }
}

TEST(BlendPostures, LeaveAPostureThatIsBlendedWithItself) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const BlendPosture p = random_postures(random, 1, 1.0)[0];
    const std::vector<BlendPosture> copies(2 + seed % 3, p);
    std::vector<PerGroup> weights;
    for (std::size_t i = 0; i < copies.size(); ++i) {
      weights.push_back(random_group_weights(random));
    }
    const BlendPosture out = blended(copies, weights);
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      EXPECT_NEAR(out.x[i], p.x[i], 1e-6);
      EXPECT_NEAR(out.y[i], p.y[i], 1e-6);
      EXPECT_NEAR(out.z[i], p.z[i], 1e-6);
      EXPECT_NEAR(out.w[i], p.w[i], 1e-6);
    }
    EXPECT_EQ(out.fold_rad, p.fold_rad);
    EXPECT_EQ(out.lower_twist_rad, p.lower_twist_rad);
    EXPECT_EQ(out.height_legs, p.height_legs);
  }
}

TEST(BlendPostures, AgreesWithTheMeanInDoublePrecision) {
  for (unsigned seed = 0; seed < 600; ++seed) {
    std::mt19937 random(seed);
    const std::size_t count = 2 + seed % 3;
    const auto postures = random_postures(random, count, kSpread_rad);
    std::vector<PerGroup> weights;
    for (std::size_t i = 0; i < count; ++i)
      weights.push_back(random_group_weights(random));
    const BlendPosture out = blended(postures, weights);
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      std::vector<glm::dquat> rotations;
      std::vector<double> of_rotation;
      for (std::size_t s = 0; s < count; ++s) {
        rotations.push_back(rotation_in(postures[s], i));
        of_rotation.push_back(static_cast<double>(weights[s][group_of_rotation()[i]]));
      }
      EXPECT_LT(
          angle_between_rad(rotation_in(out, i), mean_rotation(rotations, of_rotation)),
          3e-6);
    }
  }
}

TEST(BlendPostures, MirrorToTheBit) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    auto postures = random_postures(random, 2 + seed % 3, kSpread_rad);
    const std::vector<PerGroup> weights(postures.size(), random_group_weights(random));
    const BlendPosture out = blended(postures, weights);
    for (BlendPosture& posture : postures) {
      for (float& y : posture.y) y = -y;
      for (float& z : posture.z) z = -z;
    }
    BlendPosture mirrored_out = blended(postures, weights);
    for (float& y : mirrored_out.y) y = -y;
    for (float& z : mirrored_out.z) z = -z;
    EXPECT_EQ(mirrored_out, out);
  }
}

// Two sources whose angle passes 180 degrees in the middle of a blend.
TEST(BlendPostures, KeepsTheSideWhileSourcesPassHalfATurn) {
  for (const std::size_t count : {2U, 3U}) {
    BlendSides sides;
    glm::dquat before{1.0, 0.0, 0.0, 0.0};
    for (int step = 0; step <= 400; ++step) {
      const double t = step / 400.0;
      const double apart_rad = (170.0 + 30.0 * t) * std::numbers::pi / 180.0;
      std::vector<BlendPosture> postures(count);
      for (std::size_t i = 0; i < kPostureRotations; ++i) {
        for (BlendPosture& p : postures) p.w[i] = 1.0F;
        set_rotation_in(postures[1], i, exp_of({0.0, apart_rad, 0.0}));
      }
      const auto weight =
          static_cast<float>(std::pow(std::sin(std::numbers::pi * t), 2.0));
      std::vector<PerGroup> weights(count, equal_weights(1.0F - weight));
      weights[1] = equal_weights(weight);
      const glm::dquat now = rotation_in(blended(postures, weights, &sides), 5);
      EXPECT_LT(angle_between_rad(before, now), 0.05) << step;
      before = now;
    }
  }
}

}  // namespace
}  // namespace marey::engine
