// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/engine.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::engine {
namespace {

SteerWish walks_to(glm::dvec2 goal_xz_m) {
  SteerWish wish;
  wish.action.clip = "walk";
  wish.goal_xz_m = goal_xz_m;
  return wish;
}

ReachWish reaches(int side, const glm::dvec3& p_in_world) {
  ReachWish wish;
  wish.action.clip = "still";
  wish.side = side;
  wish.target.p_in_world = p_in_world;
  wish.target.speed_m_s = 0.0;
  return wish;
}

TEST(EngineModels, WalkToGoalsAllAround) {
  testing::Dice dice(5);
  for (int i = 0; i < 12; ++i) {
    Engine engine = *Engine::make(made_base());
    const Skeleton body = i == 0 ? made_skeleton() : testing::random_humanoid(dice);
    const CharacterId ann = *engine.add(made_character(body));
    const double angle = 0.5236 * i;
    const glm::dvec2 goal(6.0 * std::sin(angle), 6.0 * std::cos(angle));
    ASSERT_TRUE(engine.play(ann, walks_to(goal)));
    double away_m = 100.0;
    for (int step = 0; step < 3000 && away_m > 0.2; ++step) {
      engine.advance();
      const RootPlace& root = engine.player(ann).blend().root();
      away_m = glm::distance(goal, glm::dvec2(root.x_m, root.z_m));
    }
    EXPECT_LE(away_m, 0.2) << "goal " << i;
  }
}

TEST(EngineModels, FollowAGoalThatJumps) {
  Engine engine = *Engine::make(made_base());
  const CharacterId ann = *engine.add(made_character());
  ASSERT_TRUE(engine.play(ann, walks_to({0.0, 8.0})));
  engine.advance(100);
  ASSERT_TRUE(engine.aim(ann, glm::dvec2(5.0, 3.0)));
  engine.advance(100);
  const glm::dvec2 last(-3.0, 5.0);
  ASSERT_TRUE(engine.aim(ann, last));
  EXPECT_FALSE(
      engine.aim(ann, glm::dvec2(std::numeric_limits<double>::quiet_NaN(), 0.0)));
  double away_m = 100.0;
  for (int step = 0; step < 3000 && away_m > 0.2; ++step) {
    engine.advance();
    const RootPlace& root = engine.player(ann).blend().root();
    away_m = glm::distance(last, glm::dvec2(root.x_m, root.z_m));
  }
  EXPECT_LE(away_m, 0.2);
}

TEST(EngineModels, ReachPlacesInFrontWithAStillTarget) {
  testing::Dice dice(8);
  for (int i = 0; i < 20; ++i) {
    Engine engine = *Engine::make(made_base());
    const Skeleton body = i == 0 ? made_skeleton() : testing::random_humanoid(dice);
    CharacterSpec spec = made_character(body);
    spec.reaches = true;
    const CharacterId ann = *engine.add(spec);
    const int side = i % 2;
    const retarget::BodyMap map = engine.player(ann).map();
    const double leg_m = map.leg_length_m;
    const double arm_m = map.arm_length_m;
    ASSERT_TRUE(engine.play(ann, [] {
      ActionWish still;
      still.clip = "still";
      return still;
    }()));
    engine.advance(2);
    const glm::dvec3 shoulder =
        engine.player(ann)
            .world_from_joint()[index(map.limbs[static_cast<std::size_t>(side)]->upper)]
            .translation;
    const glm::dvec3 target = shoulder + glm::dvec3((side == 0 ? 0.2 : -0.2) * arm_m,
                                                    (0.1 * (i % 4) - 0.3) * arm_m,
                                                    0.75 * arm_m);
    const ReachWish wish = reaches(side, target);
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->reachable) << leg_m;
    ASSERT_TRUE(engine.play(ann, wish));
    engine.advance(62);
    const ReachPlayer* reach = engine.player(ann).reaching(side);
    ASSERT_NE(reach, nullptr);
    EXPECT_TRUE(reach->last().has_arrived) << i;
    const RigidTransform hand =
        engine.player(ann)
            .world_from_joint()[index(map.limbs[static_cast<std::size_t>(side)]->end)];
    const double palm_m = reach_lengths(body, map, side).palm_m;
    EXPECT_NEAR(glm::distance(hand.translation, target), palm_m, 1e-3) << i;
  }
}

// Three captured reaches: that of the made base, and two with the right arm elsewhere,
// which arrive at other times.
std::shared_ptr<const MotionBase> base_with_family() {
  const auto plain = made_base();
  MoveSet moves{plain->layout(), {plain->clips().begin(), plain->clips().end()}};
  const MotionClip still = plain->clip(*plain->find("still"));
  const auto add = [&](const char* name, double yaw_rad, double arrive_s) {
    MotionClip clip = still;
    clip.name = name;
    clip.notes = {{"arrive", arrive_s, arrive_s}};
    for (BlendPosture& frame : clip.frames) {
      const std::size_t arm = kLimbRotation + 1;
      const glm::dquat now(static_cast<double>(frame.w[arm]),
                           static_cast<double>(frame.x[arm]),
                           static_cast<double>(frame.y[arm]),
                           static_cast<double>(frame.z[arm]));
      const glm::dquat turned = glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * now;
      frame.w[arm] = static_cast<float>(turned.w);
      frame.x[arm] = static_cast<float>(turned.x);
      frame.y[arm] = static_cast<float>(turned.y);
      frame.z[arm] = static_cast<float>(turned.z);
    }
    moves.clips.push_back(std::move(clip));
  };
  add("still.inwards", 0.6, 0.8);
  add("still.outwards", -0.5, 1.2);
  return *MotionBase::make(std::move(moves));
}

TEST(EngineModels, ReachWithAFamilyOnRandomBodies) {
  testing::Dice dice(13);
  const auto base = base_with_family();
  for (int i = 0; i < 20; ++i) {
    Engine engine = *Engine::make(base);
    CharacterSpec spec =
        made_character(i == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.reaches = true;
    spec.start = {1.0, 2.0, dice.between(-3.0, 3.0)};
    const CharacterId ann = *engine.add(spec);
    ActionWish stands;
    stands.clip = "still";
    ASSERT_TRUE(engine.play(ann, stands));
    engine.advance(2);
    const retarget::BodyMap& map = engine.player(ann).map();
    const glm::dvec3 shoulder =
        engine.player(ann).world_from_joint()[index(map.limbs[1]->upper)].translation;
    const glm::dquat heading =
        glm::angleAxis(spec.start.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 target =
        shoulder +
        heading * (map.arm_length_m *
                   glm::dvec3(dice.between(-0.4, 0.2), dice.between(-0.3, 0.1), 0.7));
    ReachWish wish = reaches(1, target);
    wish.family = {"still.inwards", "still.outwards"};
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->reachable) << i;
    const auto main = engine.play(ann, wish);
    ASSERT_TRUE(main);
    engine.advance(5);
    EXPECT_LE(engine.player(ann).blend().actions().size(), 4U);
    bool has_arrived = false;
    for (int step = 0; step < 75 && !has_arrived; ++step) {
      engine.advance();
      const ReachPlayer* reach = engine.player(ann).reaching(1);
      has_arrived = reach != nullptr && reach->last().has_arrived;
    }
    ASSERT_TRUE(has_arrived) << i;
    const RigidTransform hand =
        engine.player(ann).world_from_joint()[index(map.limbs[1]->end)];
    const double palm_m =
        reach_lengths(engine.player(ann).character().skeleton, map, 1).palm_m;
    EXPECT_NEAR(glm::distance(hand.translation, target), palm_m, 1e-3) << i;
    ASSERT_TRUE(engine.stop(ann, *main));
    engine.advance(60);
    EXPECT_EQ(engine.player(ann).blend().actions().size(), 0U);
  }
}

TEST(EngineModels, StandingFeetOfSteeredWalksStay) {
  testing::Dice dice(47);
  for (int i = 0; i < 12; ++i) {
    Engine engine = *Engine::make(made_base());
    const CharacterId ann = *engine.add(
        made_character(i == 0 ? made_skeleton() : testing::random_humanoid(dice)));
    const double angle = 0.5236 * i;
    ASSERT_TRUE(
        engine.play(ann, walks_to({5.0 * std::sin(angle), 5.0 * std::cos(angle)})));
    const retarget::BodyMap& map = engine.player(ann).map();
    std::array<bool, 2> stood{};
    std::array<double, 2> yaw_rad{};
    std::array<std::array<glm::dvec2, 2>, 2> before{};
    int stood_steps = 0;
    int still_steps = 0;
    for (int step = 0; step < 400; ++step) {
      engine.advance();
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t joint = index(*map.joint_of[index(
            side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot)]);
        const RigidTransform foot = engine.player(ann).world_from_joint()[joint];
        const glm::dvec3 along = foot.rotation *
                                 glm::conjugate(map.joints[joint].t_pose_from_joint) *
                                 map.feet[side].ball_from_ankle_in_t_pose;
        const glm::dvec3 ball = foot.translation + along;
        const double yaw = std::atan2(along.x, along.z);
        const std::array<glm::dvec2, 2> now{
            glm::dvec2(foot.translation.x, foot.translation.z),
            glm::dvec2(ball.x, ball.z)};
        const bool stands = engine.player(ann).report().stands[side];
        if (stands && stood[side]) {
          EXPECT_LT(std::abs(std::remainder(yaw - yaw_rad[side], 6.283185307)), 0.0087)
              << i << " step " << step;
          // The slower one of ankle and ball bears.
          const double slide_m = std::min(glm::distance(now[0], before[side][0]),
                                          glm::distance(now[1], before[side][1]));
          ++stood_steps;
          if (slide_m < 0.003 / 60.0) ++still_steps;
        } else {
          yaw_rad[side] = yaw;
        }
        stood[side] = stands;
        before[side] = now;
      }
    }
    // The others are landings and changes to the ball, in which a foot stops.
    EXPECT_GT(stood_steps, 300) << i;
    EXPECT_GT(still_steps, 0.85 * stood_steps) << i;
  }
}

TEST(EngineModels, AreRefusedByName) {
  Engine engine = *Engine::make(made_base());
  const CharacterId ann = *engine.add(made_character());
  EXPECT_FALSE(engine.play(ann, reaches(1, glm::dvec3(0.0))));  // No slots for hands.
  SteerWish once = walks_to({1.0, 1.0});
  once.action.clip = "steps";
  EXPECT_FALSE(engine.play(ann, once));
  EXPECT_FALSE(engine.aim(ann, glm::dvec2(1.0, 1.0)));  // Nothing is steered.
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId bob = *engine.add(spec);
  ReachWish bad = reaches(1, glm::dvec3(0.0));
  bad.arrive = "never";
  EXPECT_FALSE(engine.play(bob, bad));
  bad = reaches(1, glm::dvec3(0.0));
  bad.family = {"still.nowhere"};
  EXPECT_FALSE(engine.play(bob, bad));
  bad.family = {"walk"};
  EXPECT_FALSE(engine.ask(bob, bad));
  bad = reaches(1, glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(engine.play(bob, bad));
}

}  // namespace
}  // namespace marey::engine
