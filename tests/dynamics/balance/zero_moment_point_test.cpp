// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/zero_moment_point.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using testing::Dice;

constexpr FrameRate kZmpRate{120.0};
constexpr std::size_t kZmpFrames = 90;

using Track = std::vector<glm::dvec3>;

template <class At>
Track sampled(const At& at, std::size_t frames = kZmpFrames) {
  Track out;
  for (std::size_t t = 0; t < frames; ++t) {
    out.push_back(at(static_cast<double>(t) / kZmpRate.hz));
  }
  return out;
}

// A random smooth motion of a centre of mass, bounded so that the body stays loaded.
Track random_com(Dice& dice) {
  const glm::dvec3 phase(dice.between(0, 6), dice.between(0, 6), dice.between(0, 6));
  const double hz = dice.between(0.3, 1.2);
  return sampled([&](double s) {
    const double w = 6.2831853 * hz * s;
    return glm::dvec3(0.1 * std::sin(w + phase.x) + 0.8 * s,
                      0.95 + 0.03 * std::sin(2 * w + phase.y),
                      0.05 * std::cos(w + phase.z));
  });
}

Track random_momentum(Dice& dice) {
  const double phase = dice.between(0, 6);
  return sampled([&](double s) {
    return glm::dvec3(0.05 * std::sin(5 * s + phase), 0.0, 0.08 * std::cos(7 * s));
  });
}

TEST(ZeroMomentPoint, StandingStillItIsTheProjectionOfTheCentre) {
  const Track com = sampled([](double) { return glm::dvec3(0.3, 0.9, -0.2); });
  for (const GroundReaction& one : ground_reactions(com, {}, kZmpRate)) {
    ASSERT_TRUE(one.zmp_xz_m);
    EXPECT_NEAR(one.zmp_xz_m->x, 0.3, 1e-10);
    EXPECT_NEAR(one.zmp_xz_m->y, -0.2, 1e-10);
    EXPECT_NEAR(one.force_m_s2.y, kStandardGravity_m_s2, 1e-9);
  }
}

TEST(ZeroMomentPoint, AConstantAccelerationMovesItByHeightOverGravity) {
  const Track com =
      sampled([](double s) { return glm::dvec3(0.5 * 1.5 * s * s, 0.8, 0); });
  const auto reactions = ground_reactions(com, {}, kZmpRate);
  for (std::size_t t = 0; t < com.size(); ++t) {
    EXPECT_NEAR(
        reactions[t].zmp_xz_m->x, com[t].x - 0.8 * 1.5 / kStandardGravity_m_s2, 1e-9);
  }
}

TEST(ZeroMomentPoint, ARotatingRodMovesItByTheChangeOfItsMomentum) {
  // A rod that is accelerated about Z with 3 kg m^2/s^2 per kilogram: the floor pushes
  // with a moment about Z, so the point is in front of the centre.
  const Track com = sampled([](double) { return glm::dvec3(0.0, 1.0, 0.0); });
  const Track momentum =
      sampled([](double s) { return glm::dvec3(0.5 * s, 0.0, 3.0 * s); });
  for (const GroundReaction& one : ground_reactions(com, momentum, kZmpRate)) {
    EXPECT_NEAR(one.zmp_xz_m->x, 3.0 / kStandardGravity_m_s2, 1e-9);
    EXPECT_NEAR(one.zmp_xz_m->y, -0.5 / kStandardGravity_m_s2, 1e-9);
  }
}

TEST(ZeroMomentPoint, AnInvertedPendulumStandsOnItsFixedPoint) {
  // x'' = (g / h) (x - p): the point is p in every frame.
  const double height_m = 0.9;
  const double pace = std::sqrt(kStandardGravity_m_s2 / height_m);
  const glm::dvec2 p(0.2, -0.1);
  const Track com = sampled([&](double s) {
    return glm::dvec3(p.x - 0.1 * std::exp(-pace * s) + 0.002 * std::exp(pace * s),
                      height_m + 0.05,
                      p.y + 0.05 * std::exp(-pace * s));
  });
  ZmpOptions options;
  options.floor_height_m = 0.05;
  const auto reactions = ground_reactions(com, {}, kZmpRate, options);
  for (std::size_t t = 8; t + 8 < com.size(); ++t) {
    EXPECT_NEAR(reactions[t].zmp_xz_m->x, p.x, 3e-4) << t;
    EXPECT_NEAR(reactions[t].zmp_xz_m->y, p.y, 3e-4) << t;
  }
}

TEST(ZeroMomentPoint, InFlightThereIsNone) {
  const Track com = sampled([](double s) {
    return glm::dvec3(2.0 * s, 1.0 + 2.0 * s - 0.5 * kStandardGravity_m_s2 * s * s, 0.0);
  });
  for (const GroundReaction& one : ground_reactions(com, {}, kZmpRate)) {
    EXPECT_FALSE(one.zmp_xz_m);
    EXPECT_NEAR(glm::length(one.force_m_s2), 0.0, 1e-8);
  }
}

TEST(ZeroMomentPoint, FollowsShiftsOfTimeHeadingsMirrorsAndFloors) {
  for (int seed = 0; seed < 200; ++seed) {
    Dice dice(static_cast<std::uint64_t>(seed));
    const Track com = random_com(dice);
    const Track momentum = random_momentum(dice);
    const auto base = ground_reactions(com, momentum, kZmpRate);
    const double turn = dice.between(-3.0, 3.0);
    const double lift_m = dice.between(-2.0, 2.0);
    const glm::dvec2 heading(std::cos(turn), std::sin(turn));
    const auto rotated = [&](const glm::dvec3& p) {
      return glm::dvec3(
          heading.x * p.x - heading.y * p.z, p.y, heading.y * p.x + heading.x * p.z);
    };
    Track turned;
    Track turned_momentum;
    Track mirrored;
    Track mirrored_momentum;
    for (std::size_t t = 0; t < com.size(); ++t) {
      turned.push_back(rotated(com[t]) + glm::dvec3(0.0, lift_m, 0.0));
      turned_momentum.push_back(rotated(momentum[t]));
      mirrored.push_back(com[t] * glm::dvec3(-1, 1, 1));
      mirrored_momentum.push_back(momentum[t] * glm::dvec3(1, -1, -1));
    }
    ZmpOptions lifted;
    lifted.floor_height_m = lift_m;
    const auto of_turned = ground_reactions(turned, turned_momentum, kZmpRate, lifted);
    const auto of_mirrored = ground_reactions(mirrored, mirrored_momentum, kZmpRate);
    const auto of_later = ground_reactions(
        std::span(com).subspan(20), std::span(momentum).subspan(20), kZmpRate);
    for (std::size_t t = 0; t < com.size(); ++t) {
      ASSERT_TRUE(base[t].zmp_xz_m);
      const glm::dvec2 p = *base[t].zmp_xz_m;
      const glm::dvec3 expected = rotated({p.x, 0.0, p.y});
      EXPECT_NEAR(of_turned[t].zmp_xz_m->x, expected.x, 1e-9);
      EXPECT_NEAR(of_turned[t].zmp_xz_m->y, expected.z, 1e-9);
      EXPECT_NEAR(of_mirrored[t].zmp_xz_m->x, -p.x, 1e-9);
      EXPECT_NEAR(of_mirrored[t].zmp_xz_m->y, p.y, 1e-9);
      if (t >= 30 && t + 10 < com.size()) {
        EXPECT_EQ(*of_later[t - 20].zmp_xz_m, p);
      }
    }
  }
}

TEST(ZeroMomentPoint, ShortMotionsAreAnswered) {
  for (std::size_t frames = 0; frames < 8; ++frames) {
    const Track com = sampled([](double) { return glm::dvec3(0.1, 1.0, 0.2); }, frames);
    const auto reactions = ground_reactions(com, com, kZmpRate);
    ASSERT_EQ(reactions.size(), frames);
    for (const GroundReaction& one : reactions) {
      ASSERT_TRUE(one.zmp_xz_m);
      EXPECT_NEAR(one.zmp_xz_m->x, 0.1, 1e-9);
    }
  }
}

}  // namespace
}  // namespace marey::dynamics
