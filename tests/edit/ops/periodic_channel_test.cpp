// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/periodic_channel.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {
namespace {

using testing::Dice;

constexpr double kTwoPi = 6.28318530717958647693;

// A wave that drifts, with noise.
std::vector<glm::dvec3> drifting(const CycleFrame& cycle, double noise, Dice& dice) {
  std::vector<glm::dvec3> out;
  for (int k = -cycle.before; k < cycle.frames + cycle.after; ++k) {
    const double x = static_cast<double>(k) / cycle.frames;
    out.emplace_back(std::sin(kTwoPi * x) + 0.1 * x + 0.05 * x * x + dice.noise(noise),
                     std::cos(kTwoPi * x) * (1.0 + 0.1 * x) + dice.noise(noise),
                     0.3 * x * x * x + dice.noise(noise));
  }
  return out;
}

std::vector<glm::dquat> as_rotations(const std::vector<glm::dvec3>& vectors) {
  std::vector<glm::dquat> out;
  for (const glm::dvec3& v : vectors) out.push_back(rotation_from_vector(v));
  return out;
}

double angle(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

std::size_t at(const CycleFrame& cycle, int k) {
  return static_cast<std::size_t>(cycle.before + k);
}

TEST(MakePeriodic, MeetsInThreeSamplesAcrossTheSeam) {
  Dice dice(3);
  const CycleFrame cycle{13, 100, 14, 12};
  for (const double noise : {0.0, 0.02}) {
    std::vector<glm::dvec3> places = drifting(cycle, noise, dice);
    std::vector<glm::dquat> turns = as_rotations(drifting(cycle, noise, dice));
    make_periodic(std::span(places), cycle);
    make_periodic(std::span(turns), cycle);
    for (const int k : {-1, 0, 1}) {
      EXPECT_LT(glm::distance(places[at(cycle, k)], places[at(cycle, cycle.frames + k)]),
                1e-14);
      EXPECT_LT(angle(turns[at(cycle, k)], turns[at(cycle, cycle.frames + k)]), 1e-12);
    }
  }
}

TEST(MakePeriodic, KeepsAPeriodicChannel) {
  const CycleFrame cycle{9, 60, 10, 8};
  std::vector<glm::dvec3> places;
  for (int k = -cycle.before; k < cycle.frames + cycle.after; ++k) {
    const double x = kTwoPi * k / cycle.frames;
    places.emplace_back(std::sin(x), std::cos(2 * x), std::sin(3 * x));
  }
  std::vector<glm::dvec3> closed = places;
  make_periodic(std::span(closed), cycle);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_LT(glm::distance(places[k], closed[k]), 1e-13);
  }
}

TEST(MakePeriodic, MovesEachEndByHalfTheGap) {
  Dice dice(4);
  const CycleFrame cycle{13, 100, 14, 12};
  const std::vector<glm::dvec3> places = drifting(cycle, 0.0, dice);
  std::vector<glm::dvec3> closed = places;
  make_periodic(std::span(closed), cycle);
  const glm::dvec3 gap = places[at(cycle, 100)] - places[at(cycle, 0)];
  EXPECT_LT(glm::distance(closed[at(cycle, 0)], places[at(cycle, 0)] + 0.5 * gap), 1e-14);
  EXPECT_LT(glm::distance(closed[at(cycle, 50)], places[at(cycle, 50)]), 1e-14);
}

TEST(MakePeriodic, DisplacesSmoothly) {
  // The slopes at the ends differ by 0.009 per sample. The blend removes that over 12
  // samples; a corner would have the whole of it as its curvature.
  Dice dice(5);
  const CycleFrame cycle{13, 100, 14, 12};
  const std::vector<glm::dvec3> places = drifting(cycle, 0.0, dice);
  std::vector<glm::dvec3> closed = places;
  make_periodic(std::span(closed), cycle);
  for (std::size_t k = 1; k + 1 < places.size(); ++k) {
    const glm::dvec3 bend = (closed[k - 1] - places[k - 1]) -
                            2.0 * (closed[k] - places[k]) +
                            (closed[k + 1] - places[k + 1]);
    EXPECT_LT(glm::length(bend), 0.003) << k;
  }
}

TEST(MakePeriodic, MeetsInValueAndSlopeWithoutSamplesBeyond) {
  Dice dice(6);
  const CycleFrame cycle{0, 100, 1, 12};
  std::vector<glm::dvec3> places = drifting(cycle, 0.0, dice);
  const auto slope_jump = [&](const std::vector<glm::dvec3>& x) {
    const glm::dvec3 after = -1.5 * x[0] + 2.0 * x[1] - 0.5 * x[2];
    const glm::dvec3 before = 1.5 * x[100] - 2.0 * x[99] + 0.5 * x[98];
    return glm::length(after - before);
  };
  const double jump = slope_jump(places);
  make_periodic(std::span(places), cycle);
  EXPECT_LT(glm::distance(places[0], places[100]), 1e-14);
  EXPECT_LT(slope_jump(places), 0.05 * jump);
}

TEST(MakePeriodic, UsesOneSideIfTheOtherIsMissing) {
  Dice dice(7);
  for (const CycleFrame& cycle :
       {CycleFrame{0, 100, 14, 12}, CycleFrame{13, 100, 1, 12}}) {
    std::vector<glm::dvec3> places = drifting(cycle, 0.0, dice);
    make_periodic(std::span(places), cycle);
    const glm::dvec3 after = places[at(cycle, 1)] - places[at(cycle, 0)];
    const glm::dvec3 before = places[at(cycle, 100)] - places[at(cycle, 99)];
    EXPECT_LT(glm::length(after - before), 0.006);
  }
}

TEST(MakePeriodic, TakesTheShorterWayRound) {
  const CycleFrame cycle{0, 4, 1, 1};
  std::vector<glm::dquat> turns(5, glm::dquat(1, 0, 0, 0));
  turns[4] = -rotation_from_vector({0.0, 0.2, 0.0});
  make_periodic(std::span(turns), cycle);
  EXPECT_NEAR(angle(turns[2], glm::dquat(1, 0, 0, 0)), 0.0, 1e-12);
  EXPECT_LT(angle(turns[0], rotation_from_vector({0.0, 0.1, 0.0})), 1e-9);
}

}  // namespace
}  // namespace marey::edit
