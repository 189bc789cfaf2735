// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/plan_jump.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/jumps/jump_reference.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/jumps/exact_jump.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using marey::testing::Dice;
using testing::ExactJump;
using testing::ExactJumpShape;
using testing::make_exact_jump;

constexpr double kG = 9.81;

ExactJumpShape random_shape(Dice& dice) {
  ExactJumpShape out;
  out.rate_hz = dice.between(60.0, 240.0);
  out.push_s = dice.between(0.6, 0.8);
  out.takeoff_m_s = dice.between(2.0, 2.6);
  out.level_m_s = {dice.between(-0.6, 0.6), 0.0, dice.between(-0.6, 1.2)};
  out.from_in_world = {dice.between(-3.0, 3.0), dice.between(-0.5, 0.5), 1.0};
  return out;
}

/// Sampled plan: times and places, one per millisecond.
std::vector<glm::dvec3> course(const JumpPlan& plan) {
  std::vector<glm::dvec3> out;
  for (double t = plan.start_s(); t < plan.rest()->time_s; t += 1e-3) {
    out.push_back(plan.com_in_world(t));
  }
  return out;
}

TEST(PlanJump, KeepsAJumpWithoutWishesToTheBit) {
  const ExactJump exact = make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  for (const JumpWish& wish : {JumpWish{}, JumpWish{.apex_by_m = 0.0}}) {
    const auto plan = plan_jump(*reference, wish);
    ASSERT_TRUE(plan) << plan.error().message();
    EXPECT_TRUE(plan->is_identity());
    EXPECT_EQ(plan->delay_s(), 0.0);
    for (std::size_t i = 0; i < exact.track.com_in_world.size(); ++i) {
      const double t = static_cast<double>(i) / exact.track.rate.hz;
      EXPECT_EQ(plan->com_in_world(t), reference->captured(t));
      EXPECT_NEAR(
          glm::distance(plan->com_in_world(t), exact.track.com_in_world[i]), 0.0, 1e-12);
    }
  }
}

TEST(PlanJump, MeetsWishesOfHundredsOfJumpsExactly) {
  Dice dice(61);
  int planned = 0;
  for (int round = 0; round < 200; ++round) {
    const ExactJump exact = make_exact_jump(random_shape(dice));
    const auto reference = JumpReference::make(exact.track, exact.jump);
    ASSERT_TRUE(reference) << round;
    const double rise_m = exact.jump.rise_m();
    const double floor_m = exact.jump.takeoff_feet_in_world.y;
    const glm::dvec3 landing = *exact.jump.landing_feet_in_world;
    const double apex_m =
        exact.jump.takeoff.p_in_world.y + dice.between(0.4, 1.6) * rise_m;
    JumpWish wish;
    wish.apex_m = apex_m - floor_m;
    wish.landing_in_world = landing + glm::dvec3(dice.between(-0.2, 0.2),
                                                 dice.between(-0.1, 0.1),
                                                 dice.between(-0.2, 0.2));
    const auto plan = plan_jump(*reference, wish);
    if (!plan) continue;
    ++planned;
    // The flight is one parabola through the wanted apex.
    double highest_m = -1e9;
    const double takeoff_s = plan->takeoff().time_s;
    const double touchdown_s = plan->touchdown()->time_s;
    const double h = (touchdown_s - takeoff_s) / 400.0;
    for (double t = takeoff_s + h; t < touchdown_s - h; t += h) {
      const glm::dvec3 second = (plan->com_in_world(t + h) - 2.0 * plan->com_in_world(t) +
                                 plan->com_in_world(t - h)) /
                                (h * h);
      ASSERT_NEAR(second.y, -kG, 1e-4) << round;
      ASSERT_NEAR(std::hypot(second.x, second.z), 0.0, 1e-4) << round;
      highest_m = std::max(highest_m, plan->com_in_world(t).y);
    }
    EXPECT_NEAR(highest_m, apex_m, 1e-4) << round;
    const glm::dvec3 moved = *wish.landing_in_world - landing;
    EXPECT_NEAR(glm::distance(plan->com_in_world(touchdown_s),
                              exact.jump.touchdown->p_in_world + moved),
                0.0,
                1e-9);
    EXPECT_NEAR(glm::distance(plan->com_in_world(plan->rest()->time_s + 0.1),
                              reference->captured(exact.jump.rest->time_s + 0.1) + moved),
                0.0,
                1e-9);
  }
  EXPECT_GE(planned, 180);
}

TEST(PlanJump, PushesAreNeverNegativeAndChangeTheMomentumAsWanted) {
  Dice dice(62);
  for (int round = 0; round < 100; ++round) {
    const ExactJump exact = make_exact_jump(random_shape(dice));
    const auto reference = JumpReference::make(exact.track, exact.jump);
    ASSERT_TRUE(reference);
    JumpWish wish;
    wish.apex_by_m = dice.between(-0.6, 0.6) * exact.jump.rise_m();
    const auto plan = plan_jump(*reference, wish);
    if (!plan) continue;
    double impulse = 0.0;
    const int steps = 4000;
    const double h = plan->push().duration_s() / steps;
    for (int k = 0; k < steps; ++k) {
      const double force = plan->push().force_m_s2((k + 0.5) * h).y;
      EXPECT_GE(force, -1e-6 * kG);
      impulse += force * h;
    }
    const double change = plan->takeoff().velocity_m_s.y -
                          exact.jump.start.velocity_m_s.y +
                          kG * plan->push().duration_s();
    EXPECT_NEAR(impulse, change, 1e-4);
  }
}

TEST(PlanJump, IsContinuousAtTheEndsOfItsPhases) {
  Dice dice(63);
  for (int round = 0; round < 50; ++round) {
    const ExactJump exact = make_exact_jump(random_shape(dice));
    const auto reference = JumpReference::make(exact.track, exact.jump);
    ASSERT_TRUE(reference);
    const auto plan = plan_jump(*reference, {.apex_by_m = 0.1});
    ASSERT_TRUE(plan) << plan.error().message();
    for (const double t : {plan->start_s(),
                           plan->takeoff().time_s,
                           plan->touchdown()->time_s,
                           plan->rest()->time_s}) {
      const double h = 1e-5;
      const glm::dvec3 before = (plan->com_in_world(t) - plan->com_in_world(t - h)) / h;
      const glm::dvec3 after = (plan->com_in_world(t + h) - plan->com_in_world(t)) / h;
      EXPECT_NEAR(glm::distance(before, after), 0.0, 0.02) << round << " at " << t;
    }
  }
}

TEST(PlanJump, FollowsTheWishContinuously) {
  const ExactJump exact = make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  std::optional<std::vector<glm::dvec3>> last;
  double last_apex_m = 0.0;
  for (double by_m = -0.15; by_m <= 0.2; by_m += 0.001) {
    const auto plan = plan_jump(*reference, {.apex_by_m = by_m, .push_s = 0.7});
    ASSERT_TRUE(plan) << by_m << plan.error().message();
    const auto now = course(*plan);
    if (last) {
      EXPECT_GT(plan->apex_m(), last_apex_m);
      const std::size_t push = 700;
      for (std::size_t i = 0; i < push; ++i) {
        EXPECT_LT(glm::distance(now[i], (*last)[i]), 0.003) << by_m << " at " << i;
      }
    }
    last = now;
    last_apex_m = plan->apex_m();
  }
}

TEST(PlanJump, DoesNotDependOnPlaceHeadingTimeOrSide) {
  ExactJumpShape shape;
  shape.level_m_s = {0.0, 0.0, 1.0};
  const ExactJump plain = make_exact_jump(shape);
  const auto reference = JumpReference::make(plain.track, plain.jump);
  ASSERT_TRUE(reference);
  const JumpWish wish{.apex_by_m = 0.08, .length_m = 1.2};
  const auto plan = plan_jump(*reference, wish);
  ASSERT_TRUE(plan) << plan.error().message();

  shape.level_m_s = {0.8, 0.0, 0.6};
  shape.from_in_world = {5.0, 0.7, -2.0};
  shape.still_s = 0.9;
  const ExactJump turned = make_exact_jump(shape);
  const auto turned_reference = JumpReference::make(turned.track, turned.jump);
  ASSERT_TRUE(turned_reference);
  const auto turned_plan = plan_jump(*turned_reference, wish);
  ASSERT_TRUE(turned_plan) << turned_plan.error().message();
  for (double t = 0.0; t < plan->rest()->time_s - plan->start_s(); t += 0.01) {
    const glm::dvec3 p = plan->com_in_world(plan->start_s() + t);
    const glm::dvec3 q = turned_plan->com_in_world(turned_plan->start_s() + t);
    const glm::dvec3 expected =
        glm::dvec3(0.8 * p.z, p.y, 0.6 * p.z) + shape.from_in_world;
    // Samples lie at other instants of the motion.
    EXPECT_NEAR(glm::distance(q, expected), 0.0, 2e-3) << t;
  }
}

TEST(PlanJump, ScalesWithTheBody) {
  ExactJumpShape shape;
  const double k = 0.36;
  const ExactJump large = make_exact_jump(shape);
  shape.rate_hz /= std::sqrt(k);
  shape.still_s *= std::sqrt(k);
  shape.push_s *= std::sqrt(k);
  shape.landing_s *= std::sqrt(k);
  shape.stand_m *= k;
  shape.takeoff_m *= k;
  shape.touchdown_m *= k;
  shape.takeoff_m_s *= std::sqrt(k);
  const ExactJump small = make_exact_jump(shape);
  const auto large_reference = JumpReference::make(large.track, large.jump);
  const auto small_reference = JumpReference::make(small.track, small.jump);
  ASSERT_TRUE(large_reference && small_reference);
  const auto large_plan = plan_jump(*large_reference, {.apex_by_m = 0.1});
  const auto small_plan = plan_jump(*small_reference, {.apex_by_m = 0.1 * k});
  ASSERT_TRUE(large_plan && small_plan);
  for (double x = 0.0; x < 1.0; x += 0.01) {
    const double t = x * large_plan->push().duration_s();
    const double expected = k * large_plan->push().p_in_world(t).y;
    EXPECT_NEAR(small_plan->push().p_in_world(std::sqrt(k) * t).y, expected, 5e-4 * k);
  }
}

TEST(PlanJump, HasAnApexOfTheEnergyAtTakeoff) {
  const ExactJump exact = make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  for (const double by_m : {-0.1, 0.05, 0.2}) {
    const auto plan = plan_jump(*reference, {.apex_by_m = by_m});
    ASSERT_TRUE(plan);
    const ComState& takeoff = plan->takeoff();
    EXPECT_NEAR(
        0.5 * takeoff.velocity_m_s.y * takeoff.velocity_m_s.y + kG * takeoff.p_in_world.y,
        kG * plan->apex_m(),
        1e-9);
    EXPECT_NEAR(plan->com_in_world(plan->apex_s()).y, plan->apex_m(), 1e-6);
  }
}

TEST(PlanJump, WarpsTimeMonotonically) {
  Dice dice(64);
  for (int round = 0; round < 100; ++round) {
    const ExactJump exact = make_exact_jump(random_shape(dice));
    const auto reference = JumpReference::make(exact.track, exact.jump);
    ASSERT_TRUE(reference);
    JumpWish wish;
    wish.apex_by_m = dice.between(-0.7, 1.0) * exact.jump.rise_m();
    const auto plan =
        plan_jump(*reference, wish, {}, {.grid_s = 1.0 / exact.track.rate.hz});
    if (!plan) continue;
    const double frames = plan->delay_s() * exact.track.rate.hz;
    EXPECT_NEAR(frames, std::round(frames), 1e-9);
    double last_s = -1.0;
    for (double t = 0.0; t < plan->rest()->time_s + 0.2; t += 1e-3) {
      EXPECT_GT(plan->source_s(t), last_s) << round;
      last_s = plan->source_s(t);
    }
    EXPECT_NEAR(
        plan->source_s(plan->rest()->time_s + 0.1), exact.jump.rest->time_s + 0.1, 1e-9);
  }
}

TEST(PlanJump, ThesisLawStaysInItsSearchSpace) {
  const ExactJump exact = make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  const auto plan =
      plan_jump(*reference, {.apex_by_m = 0.05}, {}, {.law = PushLawKind::kThesis});
  ASSERT_TRUE(plan) << plan.error().message();
  const double lowest_s = plan->push().lowest().at * plan->push().duration_s();
  for (double t = 0.0; t < plan->push().duration_s(); t += 1e-3) {
    EXPECT_GE(plan->push().force_m_s2(t).y, -1e-6);
    const double up = plan->push().velocity_m_s(t).y;
    if (t < lowest_s - 1e-3) {
      EXPECT_LE(up, 1e-6);
    }
    if (t > lowest_s + 1e-3) {
      EXPECT_GE(up, -1e-6);
    }
  }
}

struct RefusedWish {
  JumpWish wish;
  std::string place;
  std::string says;
};

TEST(PlanJump, RefusesContradictionsWithThePossibleRange) {
  const ExactJump exact = make_exact_jump();
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  const double nan = std::nan("");
  const std::vector<RefusedWish> cases{
      {{.apex_m = 1.0}, "apex_m", "choose more than 1.080 m"},
      {{.apex_by_m = -0.5}, "apex_by_m", "choose more than"},
      {{.apex_m = 1.5, .apex_by_m = 0.1}, "apex_by_m", "leave one of the two out"},
      {{.apex_m = 1.5, .airtime_s = 0.2}, "airtime_s", "contradicts the apex"},
      {{.airtime_s = nan}, "airtime_s", "choose 0.02 to 20"},
      {{.airtime_s = 0.001}, "airtime_s", "choose 0.02 to 20"},
      {{.length_m = 1.0, .landing_in_world = glm::dvec3(0.0)}, "land_m", "length_m"},
      {{.landing_in_world = glm::dvec3(nan)}, "land_m", "finite"},
      {{.box_m = 0.9}, "jump", "does not get that high"},
      {{.apex_by_m = 20.0}, "jump", "choose an apex between"},
      {{.push_s = 0.0}, "push_s", "choose 0.05 to 10"},
  };
  for (const RefusedWish& refused : cases) {
    const auto plan = plan_jump(*reference, refused.wish);
    ASSERT_FALSE(plan) << refused.says;
    EXPECT_EQ(plan.error().where, refused.place);
    EXPECT_NE(plan.error().message().find(refused.says), std::string::npos)
        << plan.error().message();
  }
}

TEST(PlanJump, ChangesOnlyTheTakeoffOfAClipThatEndsInFlight) {
  ExactJump exact = make_exact_jump();
  exact.jump.touchdown.reset();
  exact.jump.rest.reset();
  exact.jump.landing_feet_in_world.reset();
  const auto frames =
      static_cast<std::size_t>((exact.jump.apex_s + 0.1) * exact.track.rate.hz);
  exact.track.com_in_world.resize(frames);
  const auto reference = JumpReference::make(exact.track, exact.jump);
  ASSERT_TRUE(reference);
  EXPECT_TRUE(plan_jump(*reference, {.apex_by_m = 0.1}));
  const auto refused = plan_jump(*reference, {.box_m = 0.1});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("cut by the end of the clip"),
            std::string::npos);
}

}  // namespace
}  // namespace marey::dynamics
