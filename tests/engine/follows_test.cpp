// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/engine.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/made_base.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::engine {
namespace {

ActionWish stands_still() {
  ActionWish wish;
  wish.clip = "still";
  return wish;
}

// A point of the shown body by the forward kinematics of core, apart from the engine.
glm::dvec3 shown_point(const Engine& engine,
                       CharacterId who,
                       HumanBone bone,
                       const glm::dvec3& offset_in_t_pose) {
  const CharacterPlayer& player = engine.player(who);
  const retarget::BodyMap& map = player.map();
  std::vector<RigidTransform> joints(player.character().skeleton.joints.size());
  world_from_joints(player.character().skeleton, engine.pose(who), joints);
  const std::size_t joint = index(*map.joint_of[index(bone)]);
  return joints[joint].translation +
         joints[joint].rotation *
             (glm::conjugate(map.joints[joint].t_pose_from_joint) * offset_in_t_pose);
}

glm::dvec3 palm_offset(const Engine& engine, CharacterId who, int side) {
  const CharacterPlayer& player = engine.player(who);
  return reach_lengths(player.character().skeleton, player.map(), side).palm_m *
         player.map().limbs[static_cast<std::size_t>(side)]->along_in_t_pose;
}

TEST(EngineFollows, PalmsFollowMovingTargetsOnRandomBodies) {
  testing::Dice dice(31);
  const auto base = made_base();
  for (int seed = 0; seed < 20; ++seed) {
    Engine engine = *Engine::make(base);
    CharacterSpec spec =
        made_character(seed == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.reaches = true;
    const CharacterId ann = *engine.add(spec);
    ASSERT_TRUE(engine.play(ann, stands_still()));
    engine.advance(2);
    const int side = seed % 2;
    const HumanBone hand = side == 0 ? HumanBone::kLeftHand : HumanBone::kRightHand;
    const glm::dvec3 palm = palm_offset(engine, ann, side);
    const retarget::BodyMap& map = engine.player(ann).map();
    const double arm_m = map.arm_length_m;
    const glm::dvec3 shoulder =
        engine.player(ann)
            .world_from_joint()[index(map.limbs[static_cast<std::size_t>(side)]->upper)]
            .translation;
    const glm::dvec3 middle = shoulder + glm::dvec3(0.0, -0.2, 0.6) * arm_m;
    FollowWish wish;
    wish.constraint = side == 0 ? "reach left" : "reach right";
    wish.target_in_world = middle;
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->reachable);
    const auto follow = engine.play(ann, wish);
    ASSERT_TRUE(follow);
    glm::dvec3 before = shown_point(engine, ann, hand, palm);
    double fastest_m_s = 0.0;
    for (int i = 0; i < 180; ++i) {
      const double t = i / 60.0;
      const glm::dvec3 target =
          t > 2.0 ? middle
                  : middle + 0.15 * arm_m *
                                 glm::dvec3(std::sin(2.0 * t), std::sin(3.0 * t), 0.0);
      ASSERT_TRUE(engine.aim(ann, *follow, target));
      engine.advance();
      const glm::dvec3 now = shown_point(engine, ann, hand, palm);
      fastest_m_s = std::max(fastest_m_s, 60.0 * glm::distance(now, before));
      before = now;
      if (t > 1.0 && t < 2.0) {
        ASSERT_LT(glm::distance(now, target), 0.01) << seed << " at " << t;
      }
    }
    EXPECT_LT(glm::distance(before, middle), 1e-3) << seed;
    EXPECT_LT(fastest_m_s, 1.1 * wish.settings.max_speed_m_s) << seed;
    EXPECT_EQ(engine.phase(ann, *follow), ActionPhase::kHolding);
  }
}

TEST(EngineFollows, ReturnToTheClipWithoutAJump) {
  Engine engine = *Engine::make(made_base());
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId ann = *engine.add(spec);
  ASSERT_TRUE(engine.play(ann, stands_still()));
  engine.advance(2);
  const glm::dvec3 palm = palm_offset(engine, ann, 1);
  const glm::dvec3 clip = shown_point(engine, ann, HumanBone::kRightHand, palm);
  FollowWish wish;
  wish.target_in_world = clip + glm::dvec3(0.05, 0.1, 0.1);
  const auto follow = engine.play(ann, wish);
  ASSERT_TRUE(follow);
  engine.advance(40);
  ASSERT_TRUE(engine.stop(ann, *follow));
  glm::dvec3 before = shown_point(engine, ann, HumanBone::kRightHand, palm);
  EXPECT_LT(glm::distance(before, wish.target_in_world), 1e-3);
  const long allocated = testing::allocations();
  engine.advance(1);
  EXPECT_EQ(testing::allocations(), allocated);
  for (int i = 0; i < 30; ++i) {
    engine.advance();
    const glm::dvec3 now = shown_point(engine, ann, HumanBone::kRightHand, palm);
    EXPECT_LT(glm::distance(now, before), 0.03) << i;
    before = now;
  }
  Engine plain = *Engine::make(made_base());
  const CharacterId bob = *plain.add(spec);
  ASSERT_TRUE(plain.play(bob, stands_still()));
  plain.advance(73);
  EXPECT_LT(glm::distance(before, shown_point(plain, bob, HumanBone::kRightHand, palm)),
            1e-4);
  EXPECT_EQ(engine.phase(ann, *follow), ActionPhase::kDone);
}

TEST(EngineFollows, LeadAnyPointOfTheSpec) {
  Engine engine = *Engine::make(made_base());
  CharacterSpec spec = made_character();
  Constraint parry;
  parry.id = "parry";
  parry.point = {"leftLowerArm", {0.12, 0.0, 0.0}};
  parry.goal = DistanceToPoint{};
  parry.activation.start_s = 1e9;
  spec.constraints.constraints.push_back(parry);
  const CharacterId ann = *engine.add(spec);
  ASSERT_TRUE(engine.play(ann, stands_still()));
  engine.advance(2);
  const auto point = [&] {
    return shown_point(
        engine, ann, HumanBone::kLeftLowerArm, parry.point.offset_in_t_pose);
  };
  FollowWish wish;
  wish.constraint = "parry";
  wish.target_in_world = point() + glm::dvec3(0.0, 0.05, 0.12);
  ASSERT_TRUE(engine.play(ann, wish));
  engine.advance(60);
  EXPECT_LT(glm::distance(point(), wish.target_in_world), 1e-3);
}

TEST(EngineFollows, AreRefusedByName) {
  Engine engine = *Engine::make(made_base());
  const CharacterId none = *engine.add(made_character());
  FollowWish wish;
  EXPECT_FALSE(engine.play(none, wish));
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId ann = *engine.add(spec);
  wish.constraint = "reach middle";
  EXPECT_FALSE(engine.play(ann, wish));
  EXPECT_FALSE(engine.ask(ann, wish));
  wish.constraint = "support left";
  EXPECT_FALSE(engine.play(ann, wish));
  wish = {};
  wish.target_in_world.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(engine.play(ann, wish));
  wish = {};
  wish.settings.max_speed_m_s = -1.0;
  EXPECT_FALSE(engine.play(ann, wish));
  wish = {};
  wish.fade_out_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(engine.play(ann, wish));
  EXPECT_FALSE(engine.aim(ann, ActionId{77}, glm::dvec3(0.0)));
}

// The base with constraints in one of its clips.
std::shared_ptr<const MotionBase> base_with(const std::string& clip,
                                            std::vector<Constraint> constraints) {
  const auto plain = made_base();
  MoveSet moves{plain->layout(), {plain->clips().begin(), plain->clips().end()}};
  for (MotionClip& each : moves.clips) {
    if (each.name == clip) each.constraints.constraints = std::move(constraints);
  }
  return *MotionBase::make(std::move(moves));
}

TEST(EngineClipConstraints, RideWithTheirActionAndItsRoot) {
  testing::Dice dice(37);
  for (int seed = 0; seed < 10; ++seed) {
    const auto plain = made_base();
    const MotionClip& still = plain->clip(*plain->find("still"));
    const ClipRoot at = still.path.front();
    const double clip_leg_m = static_cast<double>(still.leg_length_m);
    const double clip_heading = static_cast<double>(at.heading_rad);
    const glm::dvec3 in_clip = glm::angleAxis(clip_heading, glm::dvec3(0, 1, 0)) *
                                   (clip_leg_m * glm::dvec3(-0.25, 1.2, 0.35)) +
                               clip_leg_m * glm::dvec3(at.x_legs, 0.0, at.z_legs);
    Constraint touch;
    touch.id = "touch";
    touch.point.segment = "rightHand";
    touch.goal = DistanceToPoint{0.0, in_clip};
    touch.activation = {0.5, 1.4, 0.3, 0.3};
    const auto base = base_with("still", {touch});
    Engine engine = *Engine::make(base);
    CharacterSpec spec =
        made_character(seed == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.constrained_clips = {"still"};
    spec.start = {dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), dice.between(-3, 3)};
    const CharacterId ann = *engine.add(spec);
    ASSERT_TRUE(engine.play(ann, stands_still()));
    const double leg_m = engine.player(ann).map().leg_length_m;
    const glm::dvec3 wanted =
        glm::angleAxis(spec.start.heading_rad, glm::dvec3(0, 1, 0)) *
            (leg_m * glm::dvec3(-0.25, 1.2, 0.35)) +
        glm::dvec3(spec.start.x_m, 0.0, spec.start.z_m);
    const auto wrist = [&] {
      return shown_point(engine, ann, HumanBone::kRightHand, glm::dvec3(0.0));
    };
    engine.advance(20);
    const glm::dvec3 free = wrist();
    engine.advance(46);  // To 1.1 s.
    EXPECT_LT(glm::distance(wrist(), wanted), 2e-3) << seed;
    engine.advance(42);  // To 1.8 s.
    EXPECT_LT(glm::distance(wrist(), free), 1e-3) << seed;
  }
}

TEST(EngineClipConstraints, AreRefusedForUnknownClips) {
  Engine engine = *Engine::make(made_base());
  CharacterSpec spec = made_character();
  spec.constrained_clips = {"stil"};
  EXPECT_FALSE(engine.add(spec));
}

}  // namespace
}  // namespace marey::engine
