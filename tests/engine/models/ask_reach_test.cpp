// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/ask_reach.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/engine/models/made_reach.h"
#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

using testing::random_direction;

constexpr glm::dvec3 kHips{0.0, 0.95, 0.0};
constexpr glm::dvec3 kShoulder{0.2, 1.42, 0.0};

ReachLengths made_lengths() {
  return {0.3, 0.26, 0.09, 0.51, 0.85};
}

ReachFeasibility ask_at(const glm::dvec3& target, const ReachShare& share) {
  ReachQuestion question;
  question.hips_in_world = kHips;
  question.shoulder_in_world = kShoulder;
  question.clip_at_arrival.p_in_world = {0.3, 1.2, 0.4};
  question.clip_remaining_s = 0.8;
  question.target.p_in_world = target;
  return ask_reach(made_lengths(), share, question);
}

// The truth: places of an arm of two bones whose joints are drawn at random.
TEST(AskReach, EveryPlaceThatABodyTakesIsReachable) {
  const ReachLengths lengths = made_lengths();
  const ReachShare share;
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const glm::dvec3 direction = random_direction(random);
    const double elbow = testing::random_between(random, share.min_elbow_rad, 3.0);
    const double a = lengths.upper_arm_m;
    const double b = lengths.forearm_m;
    const double arm = std::sqrt(a * a + b * b - 2.0 * a * b * std::cos(elbow));
    const glm::dvec3 target = kShoulder + arm * direction;
    EXPECT_TRUE(ask_at(target, share).reachable);
    EXPECT_EQ(ask_at(target, share).missing_m, 0.0);
  }
}

TEST(AskReach, MissingIsTheDistanceBeyondTheArm) {
  ReachShare arm_alone;
  arm_alone.lean_rad = 0.0;
  arm_alone.step_legs = 0.0;
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, 0.2, 1.0));
  const ReachFeasibility far = ask_at(kShoulder + 1.0 * direction, arm_alone);
  EXPECT_FALSE(far.reachable);
  EXPECT_NEAR(far.missing_m, 1.0 - 0.999 * 0.56 - 0.09, 1e-9);
  // Trunk and hips help, by at most their share.
  const ReachFeasibility helped = ask_at(kShoulder + 1.0 * direction, {});
  EXPECT_LT(helped.missing_m, far.missing_m - 0.05 * 0.85);
  EXPECT_GT(helped.missing_m, far.missing_m - 0.05 * 0.85 - 0.35 * 0.52);
  const ReachBall ball =
      reach_ball(made_lengths(), {}, kHips, kShoulder, kShoulder + 1.0 * direction);
  EXPECT_NEAR(
      glm::distance(ball.centre_in_world, kShoulder + 1.0 * direction) - ball.radius_m,
      helped.missing_m,
      1e-9);
}

TEST(AskReach, DurationIsThatOfClipOrHand) {
  EXPECT_NEAR(ask_at({0.3, 1.3, 0.4}, {}).duration_s, 0.8, 1e-12);
  ReachOptions slow;
  slow.max_acceleration_m_s2 = 1.0;
  ReachQuestion question;
  question.hips_in_world = kHips;
  question.shoulder_in_world = kShoulder;
  question.clip_at_arrival.p_in_world = {0.3, 1.2, 0.4};
  question.clip_remaining_s = 0.8;
  question.target.p_in_world = {0.3, 1.5, 0.4};
  // sqrt(5.77 * 0.3 / 1)
  EXPECT_NEAR(ask_reach(made_lengths(), {}, question, slow).duration_s, 1.316, 0.03);
}

TEST(AskReach, LengthsAreThoseOfTheBody) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto map = retarget::map_body(skeleton);
  ASSERT_TRUE(map);
  const ReachLengths lengths = reach_lengths(skeleton, *map, 0);
  EXPECT_NEAR(lengths.upper_arm_m + lengths.forearm_m, map->arm_length_m, 1e-3);
  EXPECT_GT(lengths.palm_m, 0.04);
  EXPECT_LT(lengths.palm_m, 0.15);
  EXPECT_GT(lengths.trunk_m, 0.3);
  EXPECT_LT(lengths.trunk_m, 0.7);
}

TEST(AskReach, StepsAndAnswersDoNotAllocate) {
  std::mt19937 random(1);
  const testing::MadeHand hand(random);
  ReachCourse course;
  course.start(0.0, hand.at(0.0), {});
  const long before = testing::allocations();
  bool reachable = true;
  for (int i = 1; i < 120; ++i) {
    ReachInput input;
    input.time_s = i / 60.0;
    input.step_s = 1.0 / 60.0;
    input.clip_now = hand.at(input.time_s);
    input.clip_at_arrival = hand.at(0.8);
    input.arrive_s = 0.8;
    input.target = ReachTarget{};
    input.target->p_in_world = {0.3, 1.3, i < 100 ? 0.4 : 1.2};
    input.target->world_from_hand = glm::dquat(0.8, 0.6, 0.0, 0.0);
    (void)course.step(input);
    reachable = reachable && ask_at(input.target->p_in_world, {}).reachable;
  }
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_FALSE(reachable);
}

}  // namespace
}  // namespace marey::engine
