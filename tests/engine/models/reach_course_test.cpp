// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_course.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/models/made_reach.h"

namespace marey::engine {
namespace {

using testing::JudgedWay;
using testing::MadeHand;
using testing::play_reach;
using testing::random_between;
using testing::random_direction;

constexpr double kReachStep_s = 1.0 / 60.0;

struct MadeReach {
  MadeHand hand;
  double arrive_s = 0.0;
  ReachTarget target;  // At time 0.
  glm::dvec3 direction{0.0};
  double speed_m_s = 0.0;

  explicit MadeReach(std::mt19937& random, bool moves) : hand(random) {
    arrive_s = random_between(random, 0.5, 1.1);
    direction = random_direction(random);
    speed_m_s = random_between(random, 0.1, 0.5);
    target.velocity_m_s =
        moves ? random_between(random, 0.0, 0.5) * random_direction(random)
              : glm::dvec3(0.0);
    target.p_in_world = hand.at(arrive_s).p_in_world - arrive_s * target.velocity_m_s +
                        random_between(random, 0.05, 0.35) * random_direction(random);
    target.approach = direction;
    target.speed_m_s = speed_m_s;
    target.world_from_hand = rotation_from_vector(1.5 * random_direction(random));
  }
  [[nodiscard]] ReachTarget target_at(double time_s) const {
    ReachTarget moved = target;
    moved.p_in_world += time_s * target.velocity_m_s;
    return moved;
  }
};

TEST(ReachCourse, ArrivesAtTwoHundredTargetsAsAsked) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const bool moves = seed % 2 == 1;
    const MadeReach made(random, moves);
    std::vector<ReachOutput> outputs;
    ReachOptions options;
    options.max_acceleration_m_s2 = 1000.0;
    const JudgedWay way = play_reach(
        made.hand,
        made.arrive_s,
        made.arrive_s + 0.6,
        kReachStep_s,
        options,
        [&](double time_s) { return made.target_at(time_s); },
        &outputs);
    const std::size_t last = way.before(made.arrive_s);
    const glm::dvec3 target = made.target_at(made.arrive_s).p_in_world;
    EXPECT_LT(glm::distance(way.place(made.arrive_s, last), target),
              moves ? 0.002 : 0.001);
    // Derivatives of places need short steps.
    const JudgedWay fine = play_reach(made.hand,
                                      made.arrive_s,
                                      made.arrive_s,
                                      kReachStep_s / 8,
                                      options,
                                      [&](double t) { return made.target_at(t); });
    const glm::dvec3 velocity =
        fine.velocity_before(made.arrive_s) - made.target.velocity_m_s;
    EXPECT_NEAR(glm::length(velocity), made.speed_m_s, 0.05 * made.speed_m_s);
    EXPECT_GT(glm::dot(glm::normalize(velocity), made.direction),
              0.99939 /* 2 degrees */);
    // The instant at which it passes the target along the approach.
    double passes_s = made.arrive_s - 0.012;
    while (glm::dot(fine.place(passes_s, fine.places.size() - 1) -
                        made.target_at(passes_s).p_in_world,
                    made.direction) < 0.0 &&
           passes_s < made.arrive_s + 0.012) {
      passes_s += 1e-4;
    }
    EXPECT_NEAR(passes_s, made.arrive_s, 0.010);
    EXPECT_TRUE(outputs.back().has_arrived);
    // Afterwards it rides with the target, with the wanted rotation.
    EXPECT_LT(
        glm::distance(way.places.back(),
                      made.target_at(static_cast<double>(outputs.size()) * kReachStep_s)
                          .p_in_world),
        1e-9);
    EXPECT_LT(glm::length(rotation_vector(outputs.back().hand.world_from_hand *
                                          glm::conjugate(*made.target.world_from_hand))),
              1e-9);
  }
}

TEST(ReachCourse, HandAcceleratesLittleMoreThanTheClip) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(1000 + seed);
    const MadeReach made(random, seed % 2 == 1);
    const JudgedWay way =
        play_reach(made.hand, made.arrive_s, 3.0, kReachStep_s, {}, [&](double time_s) {
          return made.target_at(time_s);
        });
    double clip_max = 0.0;
    for (double t = 0.0; t <= 3.0; t += 0.01) {
      clip_max = std::max(clip_max, glm::length(made.hand.at(t).acceleration_m_s2));
    }
    EXPECT_LT(way.max_acceleration(made.arrive_s), clip_max + 26.0);
  }
}

// The prediction knows the velocity alone: half of 1.25 m/s^2 times (3 steps)^2 is 1.6
// mm.
TEST(ReachCourse, MeetsAndRidesATargetOnACircle) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(3000 + seed);
    const MadeReach made(random, false);
    const glm::dvec3 centre = made.target.p_in_world;
    const auto target_at = [&](double time_s) {
      ReachTarget target;
      const double angle = 2.5 * time_s;
      target.p_in_world =
          centre + 0.2 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
      target.velocity_m_s = 0.5 * glm::dvec3(-std::sin(angle), std::cos(angle), 0.0);
      return target;
    };
    const JudgedWay way =
        play_reach(made.hand, made.arrive_s, 2.0, kReachStep_s, {}, target_at);
    EXPECT_LT(glm::distance(way.place(made.arrive_s, way.before(made.arrive_s)),
                            target_at(made.arrive_s).p_in_world),
              0.002);
    const std::size_t last = way.places.size() - 1;
    EXPECT_LT(glm::distance(way.places[last], target_at(way.time_s(last)).p_in_world),
              1e-9);
  }
}

// A way with a jump in its acceleration keeps that jump however short the steps are.
TEST(ReachCourse, WayHasTwoContinuousDerivativesThoughTheTargetJumps) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(2000 + seed);
    const MadeReach made(random, true);
    const glm::dvec3 jump = 0.2 * random_direction(random);
    const double jumps_s = random_between(random, 0.1, 1.6);
    ReachOptions options;
    if (seed % 3 == 0) options.after = AfterArrival::kReturn;
    const auto target_at = [&](double time_s) {
      ReachTarget target = made.target_at(time_s);
      if (time_s > jumps_s) target.p_in_world += jump;
      return target;
    };
    const JudgedWay coarse =
        play_reach(made.hand, made.arrive_s, 2.5, 1.0 / 120, options, target_at);
    const JudgedWay fine =
        play_reach(made.hand, made.arrive_s, 2.5, 1.0 / 1920, options, target_at);
    EXPECT_LT(fine.max_jump(), std::max(0.3 * coarse.max_jump(), 1.0));
  }
}

TEST(ReachCourse, ReturnedDerivativesAreThoseOfTheWay) {
  std::mt19937 random(7);
  const MadeReach made(random, true);
  const double step_s = 1e-3;
  std::vector<ReachOutput> outputs;
  const JudgedWay way = play_reach(
      made.hand,
      made.arrive_s,
      2.0,
      step_s,
      {},
      [&](double time_s) { return made.target_at(time_s); },
      &outputs);
  for (std::size_t i = 1; i + 1 < outputs.size(); ++i) {
    const HandMotion& hand = outputs[i].hand;
    const HandMotion& next = outputs[i + 1].hand;
    const HandMotion& before = outputs[i - 1].hand;
    const glm::dvec3 velocity = (next.p_in_world - before.p_in_world) / (2.0 * step_s);
    EXPECT_LT(glm::distance(velocity, hand.velocity_m_s), 2e-3);
    EXPECT_LT(glm::distance(way.acceleration(i + 1), hand.acceleration_m_s2), 1.0);
    const glm::dvec3 turn =
        rotation_vector(next.world_from_hand * glm::conjugate(before.world_from_hand)) /
        (2.0 * step_s);
    EXPECT_LT(glm::distance(turn, hand.turn_rad_s), 1e-2);
  }
}

TEST(ReachCourse, TurnedWorldTurnsTheWay) {
  std::mt19937 random(8);
  const MadeReach made(random, true);
  const glm::dquat turn = rotation_from_vector({0.3, 1.2, -0.5});
  ReachCourse plain;
  ReachCourse turned;
  const auto turned_hand = [&](HandMotion hand) {
    hand.p_in_world = turn * hand.p_in_world;
    hand.velocity_m_s = turn * hand.velocity_m_s;
    hand.acceleration_m_s2 = turn * hand.acceleration_m_s2;
    hand.world_from_hand = turn * hand.world_from_hand;
    hand.turn_rad_s = turn * hand.turn_rad_s;
    hand.turn_acceleration_rad_s2 = turn * hand.turn_acceleration_rad_s2;
    return hand;
  };
  plain.start(0.0, made.hand.at(0.0), {});
  turned.start(0.0, turned_hand(made.hand.at(0.0)), {});
  for (int i = 1; i < 90; ++i) {
    ReachInput input;
    input.time_s = i * kReachStep_s;
    input.step_s = kReachStep_s;
    input.clip_now = made.hand.at(input.time_s);
    input.clip_at_arrival = made.hand.at(made.arrive_s);
    input.arrive_s = made.arrive_s;
    input.target = made.target_at(input.time_s);
    const ReachOutput a = plain.step(input);
    input.clip_now = turned_hand(input.clip_now);
    input.clip_at_arrival = turned_hand(input.clip_at_arrival);
    input.target->p_in_world = turn * input.target->p_in_world;
    input.target->velocity_m_s = turn * input.target->velocity_m_s;
    input.target->approach = turn * *input.target->approach;
    input.target->world_from_hand = turn * *input.target->world_from_hand;
    const ReachOutput b = turned.step(input);
    EXPECT_LT(glm::distance(turn * a.hand.p_in_world, b.hand.p_in_world), 1e-7);
  }
}

// The hand of the clip stands, so playing it slower changes nothing but the event.
TEST(ReachCourse, PutsOffAnArrivalThatIsTooEarly) {
  ReachCourse course;
  const HandMotion clip;
  course.start(0.0, clip, {});
  double arrive_s = 0.2;
  double clip_s = 0.0;
  double arrived_s = 0.0;
  ReachOutput output;
  for (int i = 1; i < 120 && !output.has_arrived; ++i) {
    ReachInput input;
    input.time_s = i * kReachStep_s;
    input.step_s = kReachStep_s;
    input.arrive_s = arrive_s;
    input.clip_remaining_s = 0.2 - clip_s;
    input.target = ReachTarget{.p_in_world = {0.4, 0.0, 0.0}};
    output = course.step(input);
    EXPECT_GE(output.rate, 0.5);
    EXPECT_GE(output.arrive_s, arrive_s - 1e-9);
    EXPECT_LT(glm::length(output.hand.acceleration_m_s2), 25.0 * 1.05);
    arrive_s = output.arrive_s;
    clip_s += output.rate * kReachStep_s;
    arrived_s = input.time_s;
  }
  EXPECT_TRUE(output.has_arrived);
  // sqrt(5.77 * 0.4 / 25); within 3 mm a few steps earlier.
  EXPECT_NEAR(arrived_s, 0.304, 0.06);
}

TEST(ReachCourse, LostAndDistantTargetsAreReported) {
  std::mt19937 random(9);
  const MadeReach made(random, true);
  ReachCourse course;
  course.start(0.0, made.hand.at(0.0), {});
  const ReachBall ball{made.hand.at(made.arrive_s).p_in_world, 0.02};
  for (int i = 1; i < 120; ++i) {
    ReachInput input;
    input.time_s = i * kReachStep_s;
    input.step_s = kReachStep_s;
    input.clip_now = made.hand.at(input.time_s);
    input.clip_at_arrival = made.hand.at(made.arrive_s);
    input.arrive_s = made.arrive_s;
    input.within = ball;
    const bool lost = i > 20;
    if (i <= 20) input.target = made.target_at(input.time_s);
    if (i > 40) {
      input.target = ReachTarget{};
      input.target->p_in_world.x = std::numeric_limits<double>::quiet_NaN();
    }
    const ReachOutput output = course.step(input);
    EXPECT_EQ(output.target_lost, lost);
    EXPECT_GT(output.missing_m, 0.0);
    EXPECT_TRUE(std::isfinite(glm::length(output.hand.p_in_world)));
    if (i == 119) {
      EXPECT_LT(glm::distance(output.hand.p_in_world, ball.centre_in_world), 0.0201);
    }
  }
}

TEST(ReachCourse, WithoutTargetStaysWithTheClip) {
  std::mt19937 random(10);
  const MadeHand hand(random);
  const JudgedWay way = play_reach(
      hand, 0.7, 1.5, kReachStep_s, {}, [](double) -> std::optional<ReachTarget> {
        return std::nullopt;
      });
  for (std::size_t i = 0; i < way.places.size(); ++i) {
    EXPECT_LT(glm::distance(way.places[i], hand.at(way.time_s(i)).p_in_world), 0.05);
  }
  EXPECT_LT(glm::distance(way.places.back(),
                          hand.at(way.time_s(way.places.size() - 1)).p_in_world),
            1e-12);
}

TEST(ReachCourse, ReleaseReturnsToTheClip) {
  std::mt19937 random(11);
  const MadeReach made(random, false);
  ReachCourse course;
  course.start(0.0, made.hand.at(0.0), {});
  ReachOutput output;
  for (int i = 1; i < 240; ++i) {
    if (i == 120) course.release();
    ReachInput input;
    input.time_s = i * kReachStep_s;
    input.step_s = kReachStep_s;
    input.clip_now = made.hand.at(input.time_s);
    input.clip_at_arrival = made.hand.at(made.arrive_s);
    input.arrive_s = made.arrive_s;
    input.target = made.target;
    output = course.step(input);
    if (i == 239) {
      EXPECT_EQ(output.hand.p_in_world, input.clip_now.p_in_world);
    }
  }
  EXPECT_EQ(output.phase, ReachPhase::kDone);
}

TEST(ReachTarget, WrongNumbersAreRefusedByName) {
  ReachTarget target;
  EXPECT_TRUE(check_target(target));
  target.p_in_world.y = std::numeric_limits<double>::quiet_NaN();
  ASSERT_FALSE(check_target(target));
  EXPECT_NE(check_target(target).error().message().find("place"), std::string::npos);
  target = {};
  target.speed_m_s = -1.0;
  ASSERT_FALSE(check_target(target));
  EXPECT_NE(check_target(target).error().message().find("arrival speed"),
            std::string::npos);
  target = {};
  target.approach = glm::dvec3(0.0);
  ASSERT_FALSE(check_target(target));
}

}  // namespace
}  // namespace marey::engine
