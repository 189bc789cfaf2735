// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/possible_speeds.h"

#include <cmath>

#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/landing_moved.h"
#include "dynamics/jumps/plan_jump.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/jumps/exact_jump.h"

namespace marey::dynamics {
namespace {

TEST(PossibleSpeeds, AreTheBorderOfPossiblePushes) {
  const testing::ExactJump exact = testing::make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  SupportWish wish;
  wish.start = exact.jump.start;
  wish.end = exact.jump.takeoff;
  wish.max_force_m_s2 = 25.0;
  const auto speeds = possible_speeds(reference->push(), wish, 8.0);
  ASSERT_TRUE(speeds);
  EXPECT_LT(speeds->low_m_s, exact.jump.takeoff.velocity_m_s.y);
  EXPECT_GT(speeds->high_m_s, exact.jump.takeoff.velocity_m_s.y);
  wish.end.velocity_m_s.y = speeds->high_m_s;
  EXPECT_TRUE(derive_support(reference->push(), wish));
  wish.end.velocity_m_s.y = speeds->high_m_s + 0.001;
  EXPECT_FALSE(derive_support(reference->push(), wish));
  wish.max_force_m_s2 = 1.0;
  EXPECT_FALSE(possible_speeds(reference->push(), wish, 8.0));
}

TEST(LandingMoved, MeetsLengthPlaceAndBox) {
  const testing::ExactJump exact =
      testing::make_exact_jump({.level_m_s = glm::dvec3(0.6, 0.0, 0.8)});
  const glm::dvec3 from = exact.jump.takeoff_feet_in_world;
  const glm::dvec3 landing = *exact.jump.landing_feet_in_world;
  const glm::dvec3 farther = landing + landing_moved(exact.jump, {.length_m = 2.5});
  EXPECT_NEAR(std::hypot(farther.x - from.x, farther.z - from.z), 2.5, 1e-12);
  EXPECT_NEAR(farther.y, landing.y, 1e-12);
  EXPECT_NEAR(
      landing.y + landing_moved(exact.jump, {.box_m = 0.4}).y, from.y + 0.4, 1e-12);
  const glm::dvec3 there(1.0, 0.2, 3.0);
  const glm::dvec3 moved = landing_moved(exact.jump, {.landing_in_world = there});
  EXPECT_NEAR(glm::distance(landing + moved, there), 0.0, 1e-12);
  EXPECT_EQ(landing_moved(exact.jump, {}), glm::dvec3(0.0));
}

TEST(PlanJump, KeepsTheHorizontalVelocityWithoutAWishOnTheLanding) {
  const testing::ExactJump exact =
      testing::make_exact_jump({.level_m_s = glm::dvec3(0.3, 0.0, 0.4)});
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  const auto plan = plan_jump(*reference, {.apex_by_m = 0.1});
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_NEAR(plan->takeoff().velocity_m_s.x, 0.3, 1e-9);
  EXPECT_NEAR(plan->takeoff().velocity_m_s.z, 0.4, 1e-9);
  EXPECT_GT(plan->landing_moved_m().z, 0.0);
}

TEST(PlanJump, SaysThatALowestPointOutsideOfTheSpaceWasMoved) {
  const testing::ExactJump exact = testing::make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  const auto plan =
      plan_jump(*reference,
                {},
                {.strength_g = 20.0},
                {.law = PushLawKind::kThesis, .lowest = LowestPoint{0.6, -5.0}});
  ASSERT_TRUE(plan) << plan.error().message();
  ASSERT_EQ(plan->findings().size(), 1U);
  EXPECT_EQ(plan->findings()[0].id, "lowest");
}

}  // namespace
}  // namespace marey::dynamics
