// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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
  bad = reaches(1, glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(engine.play(bob, bad));
}

}  // namespace
}  // namespace marey::engine
