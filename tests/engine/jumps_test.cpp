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

#include "core/signal/quintic.h"
#include "tests/engine/made_base.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::engine {
namespace {

constexpr double kStand_s = 0.5;
constexpr double kSquat_s = 0.4;
constexpr double kPush_s = 0.25;
constexpr double kUp_m_s = 2.4;
constexpr double kLand_s = 0.3;
constexpr double kRise_s = 0.6;
constexpr double kAir_s = 2.0 * kUp_m_s / 9.81;
constexpr double kTakeoff_s = kStand_s + kSquat_s + kPush_s;
constexpr double kTouchdown_s = kTakeoff_s + kAir_s;
constexpr double kDuration_s = kTouchdown_s + kLand_s + kRise_s + 0.5;

using Height = Motion2<double>;
const Height kStands{-0.04, 0.0, 0.0};
const Height kLowest{-0.24, 0.0, 14.0};
const Height kLeaves{0.0, kUp_m_s, -9.81};

// Height of the hips above that of the take-off. [m]
double made_height(double t) {
  if (t < kStand_s) return kStands.value;
  t -= kStand_s;
  if (t < kSquat_s) return quintic(kStands, kLowest, kSquat_s, t).value;
  t -= kSquat_s;
  if (t < kPush_s) return quintic(kLowest, kLeaves, kPush_s, t).value;
  t -= kPush_s;
  if (t < kAir_s) return t * (kUp_m_s - 0.5 * 9.81 * t);
  t -= kAir_s;
  const Height lands{0.0, -kUp_m_s, -9.81};
  if (t < kLand_s) return quintic(lands, kLowest, kLand_s, t).value;
  t -= kLand_s;
  return t < kRise_s ? quintic(kLowest, kStands, kRise_s, t).value : kStands.value;
}

void set_rotation_of(BlendPosture& posture, std::size_t i, const glm::dquat& q) {
  posture.w[i] = static_cast<float>(q.w);
  posture.x[i] = static_cast<float>(q.x);
  posture.y[i] = static_cast<float>(q.y);
  posture.z[i] = static_cast<float>(q.z);
}

glm::dquat rotation_in(const BlendPosture& posture, std::size_t i) {
  return {static_cast<double>(posture.w[i]),
          static_cast<double>(posture.x[i]),
          static_cast<double>(posture.y[i]),
          static_cast<double>(posture.z[i])};
}

// A jump in place with folded legs: the made base with a clip "jump", which is exact for
// its own body.
std::shared_ptr<const MotionBase> base_with_jump() {
  const auto plain = made_base();
  MoveSet moves{plain->layout(), {plain->clips().begin(), plain->clips().end()}};
  MotionClip jump = plain->clip(*plain->find("still"));
  const retarget::BodyMap map = *retarget::map_body(made_skeleton());
  const Rig rig = make_rig(made_skeleton(), map);
  BlendPosture still = jump.frames.front();
  set_rotation_of(still, kSegmentRotation, glm::dquat(1, 0, 0, 0));
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t limb = kLimbRotation + 2 + side;
    const glm::dquat now = rotation_in(still, limb);
    const glm::dvec3 along = now * glm::dvec3(0, 0, 1);
    const glm::dvec3 axis = glm::cross(along, glm::dvec3(0, -1, 0));
    const double sine = glm::length(axis);
    const double angle = std::atan2(sine, -along.y);
    set_rotation_of(still, limb, glm::angleAxis(angle, axis / sine) * now);
    set_rotation_of(still, kSegmentRotation + 7 + side, glm::dquat(1, 0, 0, 0));
  }
  jump.name = "jump";
  jump.rate_hz = 120.0F;
  jump.notes = {{"apex", 0.5 * (kTakeoff_s + kTouchdown_s), 0.0}};
  jump.notes[0].end_s = jump.notes[0].start_s;
  jump.frames.clear();
  jump.path.clear();
  for (int i = 0; i / 120.0 <= kDuration_s; ++i) {
    const double high = made_height(i / 120.0) / rig.leg_length_m;
    // The legs carry the hips up to the height of the take-off.
    const double leg = 0.985 * rig.leg_legs[0] + std::min(0.0, high);
    BlendPosture posture = still;
    posture.fold_rad[2] = static_cast<float>(std::acos(leg / rig.leg_legs[0]));
    posture.fold_rad[3] = static_cast<float>(std::acos(leg / rig.leg_legs[1]));
    posture.height_legs =
        static_cast<float>(0.985 * rig.leg_legs[0] + high - rig.hip_from_hips_legs[0].y +
                           rig.ankle_height_legs[0]);
    jump.frames.push_back(posture);
    jump.path.push_back({});
  }
  for (auto& spans : jump.contacts) {
    spans = {{0.0F, static_cast<float>(kTakeoff_s)},
             {static_cast<float>(kTouchdown_s), static_cast<float>(jump.duration_s())}};
  }
  moves.clips.push_back(std::move(jump));
  return *MotionBase::make(std::move(moves));
}

JumpWish jumps() {
  JumpWish wish;
  wish.action.clip = "jump";
  wish.action.entry_s = 0.0;
  wish.action.entry_search_s = 0.0;
  return wish;
}

// Centre of mass of the shown body, by its masses and the forward kinematics of core.
glm::dvec3 shown_com(const Engine& engine, CharacterId who) {
  const Character& character = engine.player(who).character();
  std::vector<RigidTransform> joints(character.skeleton.joints.size());
  world_from_joints(character.skeleton, engine.pose(who), joints);
  glm::dvec3 sum(0.0);
  double total = 0.0;
  for (const PointMass& mass : character.masses) {
    const RigidTransform& joint = joints[index(mass.joint)];
    sum += mass.mass_kg * (joint.translation + joint.rotation * mass.p_in_joint);
    total += mass.mass_kg;
  }
  return sum / total;
}

struct PlayedJump {
  double apex_m = 0.0;
  glm::dvec3 landed{0.0};  // Centre of mass at the end, on the floor.
};

PlayedJump play_jump(Engine& engine, CharacterId who) {
  PlayedJump out;
  for (int i = 0; i < 200; ++i) {
    engine.advance();
    const glm::dvec3 com = shown_com(engine, who);
    out.apex_m = std::max(out.apex_m, com.y);
    out.landed = com;
  }
  return out;
}

TEST(EngineJumps, ReachTheirApexOnRandomBodies) {
  testing::Dice dice(41);
  const auto base = base_with_jump();
  for (int seed = 0; seed < 20; ++seed) {
    Engine engine = *Engine::make(base);
    CharacterSpec spec =
        made_character(seed == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.start = {1.0, -2.0, 0.7};
    const CharacterId ann = *engine.add(spec);
    JumpWish wish = jumps();
    const auto captured = engine.ask(ann, wish);
    ASSERT_TRUE(captured) << captured.error().message();
    ASSERT_TRUE(captured->reachable) << captured->why;
    Engine plain = *Engine::make(base);
    const CharacterId bob = *plain.add(spec);
    ASSERT_TRUE(plain.play(bob, wish));
    const PlayedJump unchanged = play_jump(plain, bob);
    const double by_m = (seed % 3 - 1) * 0.08;
    wish.changes.apex_by_m = by_m;
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    ASSERT_TRUE(answer->reachable) << answer->why;
    EXPECT_NEAR(answer->apex_m - captured->apex_m, by_m, 1e-6);
    ASSERT_TRUE(engine.play(ann, wish));
    const PlayedJump played = play_jump(engine, ann);
    EXPECT_NEAR(played.apex_m - unchanged.apex_m, by_m, 0.01) << seed;
  }
}

TEST(EngineJumps, LandAtTheAskedPlace) {
  testing::Dice dice(43);
  const auto base = base_with_jump();
  for (int seed = 0; seed < 10; ++seed) {
    Engine engine = *Engine::make(base);
    CharacterSpec spec =
        made_character(seed == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.start = {dice.between(-2.0, 2.0), 0.3, dice.between(-3.0, 3.0)};
    const CharacterId ann = *engine.add(spec);
    JumpWish wish = jumps();
    const double far_m = 0.25 * engine.player(ann).map().leg_length_m;
    const double heading = spec.start.heading_rad;
    Engine plain = *Engine::make(base);
    const CharacterId bob = *plain.add(spec);
    const auto plays = plain.play(bob, wish);
    ASSERT_TRUE(plays) << plays.error().message();
    const PlayedJump in_place = play_jump(plain, bob);
    const auto body = engine.player(ann).jump_body(*base->find("jump"), 0);
    ASSERT_TRUE(body);
    const glm::dquat turn = glm::angleAxis(heading, glm::dvec3(0.0, 1.0, 0.0));
    const double angle = dice.between(-3.0, 3.0);
    const glm::dvec3 moved =
        turn * (far_m * glm::dvec3(std::sin(angle), 0.0, std::cos(angle)));
    wish.landing_in_world = glm::dvec3(spec.start.x_m, 0.0, spec.start.z_m) +
                            turn * *(*body)->captured().landing_feet_in_world + moved;
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    ASSERT_TRUE(answer->reachable) << answer->why;
    ASSERT_TRUE(engine.play(ann, wish));
    const PlayedJump played = play_jump(engine, ann);
    const glm::dvec3 by = played.landed - in_place.landed;
    EXPECT_NEAR(by.x, moved.x, 0.01) << seed;
    EXPECT_NEAR(by.z, moved.z, 0.01) << seed;
  }
}

TEST(EngineJumps, AreRefusedByName) {
  Engine engine = *Engine::make(base_with_jump());
  const CharacterId ann = *engine.add(made_character());
  JumpWish wish = jumps();
  wish.changes.apex_m = 9.0;
  const auto answer = engine.ask(ann, wish);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->reachable);
  EXPECT_FALSE(answer->why.empty());
  EXPECT_FALSE(engine.play(ann, wish));
  wish = jumps();
  wish.jump = 1;
  EXPECT_FALSE(engine.play(ann, wish));
  wish = jumps();
  wish.changes.airtime_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(engine.play(ann, wish));
  wish = jumps();
  wish.landing_in_world = glm::dvec3(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(engine.play(ann, wish));
  wish = jumps();
  wish.action.clip = "walk";
  EXPECT_FALSE(engine.play(ann, wish));
  wish.action.clip = "still";
  EXPECT_FALSE(engine.ask(ann, wish));
}

TEST(EngineJumps, PlayManyWithoutGrowth) {
  Engine engine = *Engine::make(base_with_jump());
  const CharacterId ann = *engine.add(made_character());
  for (int i = 0; i < 8; ++i) {
    JumpWish wish = jumps();
    wish.changes.apex_by_m = 0.01 * (i + 1);
    ASSERT_TRUE(engine.play(ann, wish));
    engine.advance(190);
  }
  EXPECT_LE(engine.player(ann).blend().base().own_count(), 2U);
}

}  // namespace
}  // namespace marey::engine
