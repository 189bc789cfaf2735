// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::engine {
namespace {

constexpr double kHz = 60.0;

Engine made_engine(int threads = 1) {
  return *Engine::make(made_base(), {.step_hz = kHz, .threads = threads});
}

ActionWish plays(std::string clip) {
  ActionWish wish;
  wish.clip = std::move(clip);
  return wish;
}

bool are_same(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

double largest_distance_m(const Skeleton& skeleton, const Pose& a, const Pose& b) {
  const auto p = world_from_joints(skeleton, a);
  const auto q = world_from_joints(skeleton, b);
  double worst = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    worst = std::max(worst, glm::distance(p[i].translation, q[i].translation));
  }
  return worst;
}

bool is_finite(const Pose& pose) {
  double sum = pose.root_in_world.x + pose.root_in_world.y + pose.root_in_world.z;
  for (const glm::dquat& q : pose.parent_from_joint) {
    sum += q.w + q.x + q.y + q.z;
    if (std::abs(glm::dot(q, q) - 1.0) > 1e-6) return false;
  }
  return std::isfinite(sum);
}

TEST(Engine, PlaysOneActionAsItsClip) {
  Engine engine = made_engine();
  CharacterSpec spec = made_character();
  spec.level = DetailLevel::kBlended;
  const CharacterId ann = *engine.add(spec);
  ASSERT_TRUE(engine.play(ann, plays("walk")));
  // The character starts at the origin, the clip where the walk is after a cycle.
  const Motion walk = testing::synthetic_walk(400, kHz).motion;
  for (int step = 0; step < 200; ++step) {
    engine.advance();
    Pose truth = walk.poses[static_cast<std::size_t>(66 + 1 + step)];
    truth.root_in_world.x += engine.pose(ann).root_in_world.x - truth.root_in_world.x;
    truth.root_in_world.z += engine.pose(ann).root_in_world.z - truth.root_in_world.z;
    EXPECT_LT(largest_distance_m(made_skeleton(), engine.pose(ann), truth), 2e-6) << step;
  }
}

TEST(Engine, TravelsAsFarAsItsClip) {
  Engine engine = made_engine();
  CharacterSpec spec = made_character();
  spec.level = DetailLevel::kBlended;
  const CharacterId ann = *engine.add(spec);
  ASSERT_TRUE(engine.play(ann, plays("walk")));
  engine.advance();
  const double start_m = engine.pose(ann).root_in_world.z;
  engine.advance(66 * 100);
  const Motion walk = testing::synthetic_walk(140, kHz).motion;
  const double cycle_m = walk.poses[133].root_in_world.z - walk.poses[67].root_in_world.z;
  EXPECT_NEAR(engine.pose(ann).root_in_world.z - start_m, 100.0 * cycle_m, 1e-3);
}

TEST(Engine, TurnsAndMovesWithTheStart) {
  Engine engine = made_engine();
  CharacterSpec spec = made_character();
  const CharacterId ann = *engine.add(spec);
  spec.start = {2.0, -1.0, 1.1};
  const CharacterId bob = *engine.add(spec);
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, plays("walk")));
  engine.advance(40);
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, plays("stroll")));
  for (int step = 0; step < 90; ++step) {
    engine.advance();
    const glm::dvec3 p = engine.pose(ann).root_in_world;
    const double c = std::cos(1.1);
    const double s = std::sin(1.1);
    const glm::dvec3 moved(2.0 + c * p.x + s * p.z, p.y, -1.0 - s * p.x + c * p.z);
    EXPECT_LT(glm::distance(engine.pose(bob).root_in_world, moved), 1e-5) << step;
  }
}

TEST(Engine, LeavesGroupsWithoutPriorityToTheBit) {
  Engine engine = made_engine();
  CharacterSpec spec = made_character();
  spec.level = DetailLevel::kBlended;
  const CharacterId ann = *engine.add(spec);
  const CharacterId bob = *engine.add(spec);
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, plays("walk")));
  ActionWish arm = plays("still");
  arm.priority = only(EditGroup::kRightArm);
  engine.advance(20);
  ASSERT_TRUE(engine.play(bob, arm));
  engine.advance(30);
  const retarget::BodyMap& map = engine.player(ann).map();
  for (const HumanBone bone :
       {HumanBone::kLeftUpperLeg, HumanBone::kRightFoot, HumanBone::kHead}) {
    const std::size_t joint = index(*map.joint_of[index(bone)]);
    EXPECT_EQ(engine.pose(ann).parent_from_joint[joint],
              engine.pose(bob).parent_from_joint[joint]);
  }
  const std::size_t arm_joint = index(*map.joint_of[index(HumanBone::kRightUpperArm)]);
  EXPECT_NE(engine.pose(ann).parent_from_joint[arm_joint],
            engine.pose(bob).parent_from_joint[arm_joint]);
}

TEST(Engine, ForgetsAnActionThatIsStoppedBeforeItsFirstStep) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  const CharacterId bob = *engine.add(made_character());
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, plays("walk")));
  engine.advance(10);
  const ActionId wave = *engine.play(bob, plays("stroll"));
  ASSERT_TRUE(engine.stop(bob, wave));
  EXPECT_FALSE(engine.stop(bob, wave));
  engine.advance(10);
  EXPECT_TRUE(are_same(engine.pose(ann), engine.pose(bob)));
}

TEST(Engine, GivesTheSameBytesForAnyNumberOfThreads) {
  Engine one = made_engine(1);
  Engine two = made_engine(2);
  testing::Dice dice(3);
  for (int i = 0; i < 12; ++i) {
    const Skeleton body = testing::random_humanoid(dice);
    for (Engine* engine : {&one, &two}) {
      const CharacterId who = *engine->add(made_character(body));
      ASSERT_TRUE(engine->play(who, plays(i % 2 == 0 ? "walk" : "stroll")));
    }
  }
  for (int step = 0; step < 60; ++step) {
    if (step == 20) {
      for (Engine* engine : {&one, &two}) {
        ASSERT_TRUE(engine->play(CharacterId{3}, plays("steps")));
      }
    }
    one.advance();
    two.advance();
  }
  for (int i = 0; i < 12; ++i) {
    EXPECT_TRUE(are_same(one.pose(CharacterId{i}), two.pose(CharacterId{i}))) << i;
  }
}

TEST(Engine, AllocatesNothingInAStep) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  ASSERT_TRUE(engine.play(ann, plays("walk")));
  engine.advance(5);
  ASSERT_TRUE(engine.play(ann, plays("stroll")));
  const long before = testing::allocations();
  engine.advance(120);
  EXPECT_EQ(testing::allocations(), before);
}

TEST(Engine, HoldsStandingFeetThroughASwitch) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  ASSERT_TRUE(engine.play(ann, plays("walk")));
  const CharacterPlayer& player = engine.player(ann);
  std::array<int, 2> stood{};
  std::array<glm::dvec3, 2> before{};
  double worst_m = 0.0;
  for (int step = 0; step < 400; ++step) {
    if (step == 130 || step == 275) {
      ASSERT_TRUE(engine.play(ann, plays(step == 130 ? "stroll" : "walk")));
    }
    engine.advance();
    for (std::size_t side = 0; side < 2; ++side) {
      const HumanBone bone = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
      const glm::dvec3 ball =
          player.world_from_joint()[index(*player.map().joint_of[index(bone)])]
              .translation;
      stood[side] = player.report().stands[side] ? stood[side] + 1 : 0;
      // The first tenth of a second brakes the foot; then the ball does not move.
      if (stood[side] > 7) worst_m = std::max(worst_m, glm::distance(ball, before[side]));
      before[side] = ball;
    }
  }
  EXPECT_LT(worst_m, 1e-3);
}

TEST(Engine, GoesOnWithTheLowerLayerAfterAClipEnds) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  const ActionId walk = *engine.play(ann, plays("walk"));
  ActionWish still = plays("still");
  still.layer = 2;
  const ActionId over = *engine.play(ann, still);
  engine.advance(30);
  EXPECT_EQ(engine.phase(ann, over), ActionPhase::kHolding);
  engine.advance(150);
  EXPECT_EQ(engine.phase(ann, over), ActionPhase::kDone);
  EXPECT_EQ(engine.phase(ann, walk), ActionPhase::kHolding);
}

TEST(Engine, StartsQueuedActionsInTheirStep) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  const ActionId steps = *engine.play(ann, plays("still"));
  ActionWish at_event = plays("walk");
  at_event.start = {ActionStart::Kind::kAtEvent, 0.0, steps, "arrive"};
  const ActionId later = *engine.play(ann, at_event);
  engine.advance(58);
  EXPECT_EQ(engine.phase(ann, later), ActionPhase::kQueued);
  engine.advance(4);
  EXPECT_NE(engine.phase(ann, later), ActionPhase::kQueued);
  ActionWish at_time = plays("stroll");
  at_time.start = {ActionStart::Kind::kAtTime, 2.0, {}, {}};
  const ActionId timed = *engine.play(ann, at_time);
  engine.advance(57);
  EXPECT_EQ(engine.phase(ann, timed), ActionPhase::kQueued);
  engine.advance(2);
  EXPECT_NE(engine.phase(ann, timed), ActionPhase::kQueued);
}

TEST(Engine, RefusesBadRequestsAndChangesNothing) {
  Engine engine = made_engine();
  const CharacterId ann = *engine.add(made_character());
  const CharacterId bob = *engine.add(made_character());
  for (const CharacterId who : {ann, bob}) ASSERT_TRUE(engine.play(who, plays("walk")));
  const ActionId endless = *engine.play(bob, plays("walk"));
  ASSERT_TRUE(engine.play(ann, plays("walk")));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<ActionWish> bad(10, plays("stroll"));
  bad[0].clip = "strol";
  bad[1].weight = kNaN;
  bad[2].priority[3] = -1.0F;
  bad[3].rate = 0.0;
  bad[4].fade_in_s = -0.1;
  bad[5].entry_s = 99.0;
  bad[6].start = {ActionStart::Kind::kAfter, 0.0, endless, {}};
  bad[7].start = {ActionStart::Kind::kAtEvent, 0.0, endless, "no such event"};
  bad[8].priority = PerGroup{};
  bad[9].clip = "steps";
  bad[9].loops = true;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const auto refused = engine.play(bob, bad[i]);
    ASSERT_FALSE(refused) << i;
    EXPECT_FALSE(refused.error().cause.empty());
    EXPECT_FALSE(refused.error().next.empty());
  }
  EXPECT_NE(engine.play(bob, bad[0]).error().next.find("stroll"), std::string::npos);
  EXPECT_FALSE(engine.play(CharacterId{7}, plays("walk")));
  EXPECT_FALSE(engine.stop(bob, ActionId{1000}));
  engine.advance(30);
  EXPECT_TRUE(are_same(engine.pose(ann), engine.pose(bob)));
}

TEST(Engine, SurvivesRandomRequests) {
  const char* asked = std::getenv("MAREY_ENGINE_REQUESTS");
  const int requests = asked == nullptr ? 3000 : std::atoi(asked);
  Engine engine = made_engine();
  testing::Dice dice(11);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(engine.add(made_character(testing::random_humanoid(dice))));
  }
  const auto draw = [&](int count) {
    return static_cast<int>(std::abs(dice.noise(1e6))) % count;
  };
  const std::vector<std::string> clips{"walk", "stroll", "steps", "still", "none"};
  std::int64_t newest = 0;
  for (int i = 0; i < requests; ++i) {
    const CharacterId who{draw(5)};
    ActionWish wish = plays(clips[static_cast<std::size_t>(draw(5))]);
    wish.transition = static_cast<TransitionKind>(draw(5));
    if (draw(3) == 0)
      wish.priority = only(kEditGroups[static_cast<std::size_t>(draw(7))]);
    if (draw(4) == 0) wish.layer = draw(3);
    if (draw(4) == 0) wish.rate = 0.1 * draw(45);
    if (draw(4) == 0) wish.fade_in_s = 0.05 * draw(20) - 0.1;
    if (draw(4) == 0) wish.replaces = false;
    if (draw(6) == 0) wish.entry_s = 0.1 * draw(30);
    if (draw(5) == 0) {
      wish.start = {static_cast<ActionStart::Kind>(draw(4)),
                    engine.time_s() + 0.1 * draw(10),
                    ActionId{newest - draw(6)},
                    "arrive"};
    }
    const int what = draw(10);
    if (what == 0) {
      (void)engine.stop(who, ActionId{newest - draw(8)});
    } else if (what == 1) {
      (void)engine.stop_all(who,
                            draw(2) == 0 ? std::nullopt : std::optional<int>(draw(3)));
    } else if (const auto action = engine.play(who, wish)) {
      newest = number(*action);
    }
    if (draw(3) != 0) continue;
    engine.advance(1 + draw(12));
    for (int c = 0; c < 4; ++c) {
      ASSERT_TRUE(is_finite(engine.pose(CharacterId{c}))) << i << " " << c;
    }
  }
}

}  // namespace
}  // namespace marey::engine
