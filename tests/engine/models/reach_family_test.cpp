// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_family.h"

#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/models/made_reach.h"

namespace marey::engine {
namespace {

using testing::random_between;
using testing::random_direction;

std::vector<FamilyMember> random_members(std::mt19937& random, std::size_t count) {
  std::vector<FamilyMember> members;
  for (std::size_t i = 0; i < count; ++i) {
    const double arrive_s = random_between(random, 0.5, 1.2);
    members.push_back({i,
                       glm::dvec3(0.0, 1.2, 0.5) + 0.4 * random_direction(random),
                       arrive_s,
                       arrive_s + random_between(random, 0.2, 1.0)});
  }
  return members;
}

void expect_consistent(const ReachFamily& family, const FamilyBlend& blend) {
  ASSERT_GE(blend.count, 1U);
  glm::dvec3 mean(0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const FamilyShare& share = blend.shares[i];
    const FamilyMember& member = family.members()[share.clip];
    EXPECT_GT(share.weight, 0.0);
    if (i > 0) {
      EXPECT_LE(share.weight, blend.shares[i - 1].weight);
    }
    sum += share.weight;
    mean += share.weight * member.arrival_in_heading_m;
    // All arrive together, within their clips.
    EXPECT_NEAR(share.rate * blend.arrive_s, member.arrive_s, 1e-12);
    EXPECT_LE(share.rate * blend.duration_s, member.duration_s + 1e-12);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_LT(glm::distance(mean, blend.arrival_in_heading_m), 1e-12);
}

// The truth: the best of many random weights is not nearer.
TEST(ReachFamily, MeanPlaceIsNearestToTheTarget) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto family = ReachFamily::make(random_members(random, 4));
    ASSERT_TRUE(family);
    const glm::dvec3 target = glm::dvec3(0.0, 1.2, 0.5) +
                              random_between(random, 0.0, 0.5) * random_direction(random);
    const FamilyBlend blend = family->blend(target);
    expect_consistent(*family, blend);
    for (int trial = 0; trial < 300; ++trial) {
      glm::dvec3 mean(0.0);
      double sum = 0.0;
      for (const FamilyMember& member : family->members()) {
        const double weight = -std::log(random_between(random, 1e-9, 1.0));
        mean += weight * member.arrival_in_heading_m;
        sum += weight;
      }
      EXPECT_GT(glm::distance(mean / sum, target), blend.missing_m(target) - 1e-4);
    }
  }
}

TEST(ReachFamily, TargetBetweenTheMembersIsMet) {
  const auto family = ReachFamily::make({{0, {0.0, 1.0, 0.0}, 0.6, 1.0},
                                         {1, {0.4, 1.0, 0.0}, 0.8, 1.2},
                                         {2, {0.0, 1.4, 0.0}, 1.0, 1.4},
                                         {3, {0.0, 1.0, 0.4}, 0.7, 1.4}});
  ASSERT_TRUE(family);
  const FamilyBlend blend = family->blend({0.1, 1.1, 0.08});
  EXPECT_EQ(blend.count, 4U);
  EXPECT_LT(blend.missing_m({0.1, 1.1, 0.08}), 1e-5);
}

TEST(ReachFamily, TargetAtAMemberIsThatMember) {
  std::mt19937 random(3);
  const auto family = ReachFamily::make(random_members(random, 12));
  ASSERT_TRUE(family);
  for (const FamilyMember& member : family->members()) {
    const FamilyBlend blend = family->blend(member.arrival_in_heading_m);
    ASSERT_EQ(blend.count, 1U);
    EXPECT_EQ(blend.shares[0].clip, member.clip);
    EXPECT_EQ(blend.shares[0].rate, 1.0);
  }
}

TEST(ReachFamily, OneMemberAndEqualMembersAreFamiliesToo) {
  const auto one = ReachFamily::make({{5, {0.3, 1.2, 0.4}, 0.6, 1.0}});
  ASSERT_TRUE(one);
  const FamilyBlend blend = one->blend({2.0, 0.0, 0.0});
  ASSERT_EQ(blend.count, 1U);
  EXPECT_EQ(blend.shares[0].clip, 5U);
  EXPECT_EQ(blend.shares[0].weight, 1.0);
  const auto equal =
      ReachFamily::make({{0, {0.3, 1.2, 0.4}, 0.6, 1.0}, {1, {0.3, 1.2, 0.4}, 0.9, 1.0}});
  ASSERT_TRUE(equal);
  expect_consistent(*equal, equal->blend({0.1, 1.0, 0.2}));
}

TEST(ReachFamily, WrongMembersAreRefused) {
  EXPECT_FALSE(ReachFamily::make({}));
  EXPECT_FALSE(ReachFamily::make({{0, {0.3, 1.2, 0.4}, 0.0, 1.0}}));
  EXPECT_FALSE(ReachFamily::make({{0, {0.3, 1.2, 0.4}, 1.1, 1.0}}));
  EXPECT_FALSE(ReachFamily::make(
      {{0, {std::numeric_limits<double>::quiet_NaN(), 1.2, 0.4}, 0.5, 1.0}}));
}

}  // namespace
}  // namespace marey::engine
