// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
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

constexpr double kRadPerDegree = 0.017453292519943295;

ThrowWish throws() {
  ThrowWish wish;
  wish.action.clip = "throw";
  wish.action.entry_search_s = 0.0;
  return wish;
}

// One posed step by the forward kinematics of core, apart from the engine.
struct PosedStep {
  double time_s = 0.0;
  glm::dvec3 wrist{0.0};
  glm::dvec3 ball{0.0};
  glm::dvec3 hips{0.0};
  double heading_rad = 0.0;
};

PosedStep posed_step(const Engine& engine, CharacterId who, int side) {
  const CharacterPlayer& player = engine.player(who);
  const retarget::BodyMap& map = player.map();
  std::vector<RigidTransform> joints(player.character().skeleton.joints.size());
  world_from_joints(player.character().skeleton, engine.pose(who), joints);
  const auto turned = [&](JointIndex joint) {
    return joints[index(joint)].rotation *
           glm::conjugate(map.joints[index(joint)].t_pose_from_joint);
  };
  const retarget::LimbMap& arm = *map.limbs[static_cast<std::size_t>(side)];
  const double palm_m = reach_lengths(player.character().skeleton, map, side).palm_m;
  PosedStep out;
  out.time_s = engine.time_s();
  out.wrist = joints[index(arm.end)].translation;
  out.ball = out.wrist + turned(arm.end) * (palm_m * arm.along_in_t_pose);
  out.hips = joints[index(map.hips())].translation;
  const glm::dquat hips = turned(map.hips());
  out.heading_rad = 2.0 * std::atan2(hips.y, hips.w);
  return out;
}

// Value and rate at a time, of the parabola through three steps.
std::array<glm::dvec3, 2> continued_to(double time_s,
                                       const std::array<PosedStep, 3>& steps,
                                       glm::dvec3 PosedStep::*value) {
  std::array<glm::dvec3, 2> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = steps[(i + 1) % 3].time_s;
    const double b = steps[(i + 2) % 3].time_s;
    const double scale = (steps[i].time_s - a) * (steps[i].time_s - b);
    out[0] += ((time_s - a) * (time_s - b) / scale) * steps[i].*value;
    out[1] += ((2.0 * time_s - a - b) / scale) * steps[i].*value;
  }
  return out;
}

// Plays a throw and judges it from the postures before the release.
struct JudgedThrow {
  ThrowParameters judged;
  ThrowResult result;
  double max_jump_m = 0.0;  // Between steps, of the wrist.
  bool released = false;
};

JudgedThrow play_and_judge(Engine& engine, CharacterId who, int side, double seconds) {
  JudgedThrow out;
  std::array<PosedStep, 3> last{};
  const double start_s = engine.time_s();
  const int steps = static_cast<int>(std::lround(seconds / engine.step_s()));
  for (int i = 0; i < steps; ++i) {
    engine.advance();
    const PosedStep now = posed_step(engine, who, side);
    const ThrowPlayer* made = engine.player(who).throwing(side);
    if (i > 2)
      out.max_jump_m = std::max(out.max_jump_m, glm::distance(now.wrist, last[2].wrist));
    if (!out.released && made->result()) {
      out.released = true;
      out.result = *made->result();
      const double at_s = out.result.ball.time_s;
      const auto wrist = continued_to(at_s, last, &PosedStep::wrist);
      const auto ball = continued_to(at_s, last, &PosedStep::ball);
      const auto hips = continued_to(at_s, last, &PosedStep::hips);
      const glm::dquat turn =
          glm::angleAxis(-last[2].heading_rad, glm::dvec3(0.0, 1.0, 0.0));
      const glm::dvec3 velocity = turn * ball[1];
      out.judged.wrist_in_heading_m =
          turn * (wrist[0] - glm::dvec3(hips[0].x, 0.0, hips[0].z));
      out.judged.azimuth_rad = std::atan2(velocity.x, velocity.z);
      out.judged.elevation_rad = std::asin(velocity.y / glm::length(velocity));
      out.judged.speed_m_s = glm::length(velocity);
      out.judged.release_s = at_s - start_s;
    }
    last = {last[1], last[2], now};
  }
  return out;
}

double angle_between_deg(const ThrowParameters& a, const ThrowParameters& b) {
  const glm::dvec3 u = throw_direction(0.0, a.azimuth_rad, a.elevation_rad);
  const glm::dvec3 v = throw_direction(0.0, b.azimuth_rad, b.elevation_rad);
  return std::asin(std::min(1.0, glm::length(glm::cross(u, v)))) / kRadPerDegree;
}

void expect_parameters(const ThrowParameters& judged,
                       const ThrowParameters& wanted,
                       const std::string& about) {
  EXPECT_LT(glm::distance(judged.wrist_in_heading_m, wanted.wrist_in_heading_m), 1e-3)
      << about;
  EXPECT_LT(angle_between_deg(judged, wanted), 0.1) << about;
  EXPECT_NEAR(judged.speed_m_s / wanted.speed_m_s, 1.0, 0.005) << about;
  EXPECT_NEAR(judged.release_s, wanted.release_s, 1e-3) << about;
}

// `by` is in [-1, 1].
ThrowChanges one_change(const ThrowParameters& captured,
                        int parameter,
                        double by,
                        double arm_m) {
  ThrowChanges out;
  const glm::dvec3& wrist = captured.wrist_in_heading_m;
  if (parameter == 0) out.x_m = wrist.x + 0.15 * arm_m * by;
  if (parameter == 1) out.y_m = wrist.y + 0.15 * arm_m * by;
  if (parameter == 2) out.z_m = wrist.z + 0.15 * arm_m * by;
  if (parameter == 3) out.azimuth_rad = captured.azimuth_rad + 0.3 * by;
  if (parameter == 4) {
    out.elevation_rad = std::clamp(captured.elevation_rad + 0.3 * by, -1.4, 1.4);
  }
  if (parameter == 5) out.speed_m_s = captured.speed_m_s * (1.0 + 0.25 * by);
  if (parameter == 6) out.release_s = captured.release_s + 0.15 * by;
  return out;
}

TEST(EngineThrows, ChangeOneParameterOnRandomBodies) {
  testing::Dice dice(17);
  const auto base = made_base();
  for (int seed = 0; seed < 28; ++seed) {
    Engine engine = *Engine::make(base, {.step_hz = 1000.0});
    const Skeleton body = seed == 0 ? made_skeleton() : testing::random_humanoid(dice);
    CharacterSpec spec = made_character(body);
    spec.reaches = true;
    spec.start = {
        dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), dice.between(-3.0, 3.0)};
    const CharacterId ann = *engine.add(spec);
    ThrowWish wish = throws();
    const auto before = engine.ask(ann, wish);
    ASSERT_TRUE(before);
    EXPECT_TRUE(before->reachable);
    const double by = -1.0 + 2.0 * (seed / 7) / 3.0;
    const double arm_m = engine.player(ann).map().arm_length_m;
    wish.asked = one_change(before->captured, seed % 7, by, arm_m);
    ASSERT_TRUE(engine.play(ann, wish));
    const JudgedThrow judged = play_and_judge(engine, ann, 1, 1.9);
    ASSERT_TRUE(judged.released) << seed;
    const ThrowParameters wanted = with_changes(before->captured, wish.asked);
    expect_parameters(judged.judged, wanted, "judged, seed " + std::to_string(seed));
    expect_parameters(
        judged.result.measured, wanted, "measured, seed " + std::to_string(seed));
  }
}

TEST(EngineThrows, MeetAPointThatMoves) {
  testing::Dice dice(23);
  const auto base = made_base();
  for (int seed = 0; seed < 12; ++seed) {
    Engine engine = *Engine::make(base, {.step_hz = 60.0});
    CharacterSpec spec =
        made_character(seed == 0 ? made_skeleton() : testing::random_humanoid(dice));
    spec.reaches = true;
    spec.start = {dice.between(-3.0, 3.0), 0.5, dice.between(-3.0, 3.0)};
    const CharacterId ann = *engine.add(spec);
    ThrowWish wish = throws();
    wish.asked.speed_m_s = 8.0;
    wish.ball.drag_1_m = seed % 2 == 0 ? 0.0 : 0.011;
    const double away_rad = spec.start.heading_rad + dice.between(-0.4, 0.4);
    glm::dvec3 point(spec.start.x_m + 3.0 * std::sin(away_rad),
                     dice.between(0.5, 1.5),
                     spec.start.z_m + 3.0 * std::cos(away_rad));
    wish.aim_in_world = point;
    const auto answer = engine.ask(ann, wish);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->aim_in_range);
    ASSERT_TRUE(engine.play(ann, wish));
    engine.advance(40);
    point += glm::dvec3(0.1, -0.1, 0.1);
    ASSERT_TRUE(engine.aim_ball(ann, 1, point));
    engine.advance(40);
    const auto& result = engine.player(ann).throwing(1)->result();
    ASSERT_TRUE(result.has_value());
    // The flight in steps of its own.
    glm::dvec3 p = result->ball.p_in_world;
    glm::dvec3 v = result->ball.velocity_m_s;
    double nearest_m = 10.0;
    constexpr double kStep_s = 1e-4;
    for (int i = 0; i < 10000; ++i) {
      v += kStep_s *
           (glm::dvec3(0.0, -9.81, 0.0) - wish.ball.drag_1_m * glm::length(v) * v);
      p += kStep_s * v;
      nearest_m = std::min(nearest_m, glm::distance(p, point));
    }
    EXPECT_LT(nearest_m, 0.01) << seed;
    ASSERT_TRUE(result->aim_miss_m.has_value());
    EXPECT_NEAR(*result->aim_miss_m, nearest_m, 0.01);
  }
}

TEST(EngineThrows, WithoutChangesAreTheirClip) {
  const auto base = made_base();
  Engine thrown = *Engine::make(base);
  Engine played = *Engine::make(base);
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId ann = *thrown.add(spec);
  const CharacterId bob = *played.add(spec);
  ASSERT_TRUE(thrown.play(ann, throws()));
  ASSERT_TRUE(played.play(bob, throws().action));
  for (int i = 0; i < 110; ++i) {
    thrown.advance();
    played.advance();
    const PosedStep a = posed_step(thrown, ann, 1);
    const PosedStep b = posed_step(played, bob, 1);
    ASSERT_LT(glm::distance(a.ball, b.ball), 0.001) << i;
  }
}

TEST(EngineThrows, StepsAllocateNothing) {
  Engine engine = *Engine::make(made_base());
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId ann = *engine.add(spec);
  ThrowWish wish = throws();
  wish.asked.speed_m_s = 6.0;
  ASSERT_TRUE(engine.play(ann, wish));
  engine.advance(2);
  const long before = testing::allocations();
  engine.advance(110);
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_TRUE(engine.player(ann).throwing(1)->is_over());
}

TEST(EngineThrows, AreRefusedByName) {
  Engine engine = *Engine::make(made_base());
  const CharacterId none = *engine.add(made_character());
  EXPECT_FALSE(engine.play(none, throws()));  // No constraints for its hands.
  CharacterSpec spec = made_character();
  spec.reaches = true;
  const CharacterId ann = *engine.add(spec);
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto is_refused = [&](const auto& change, const std::string& because) {
    ThrowWish wish = throws();
    change(wish);
    const auto answer = engine.play(ann, wish);
    ASSERT_FALSE(answer);
    EXPECT_NE(answer.error().message().find(because), std::string::npos)
        << answer.error().message();
    EXPECT_FALSE(engine.ask(ann, wish));
  };
  is_refused([](ThrowWish& w) { w.side = 2; }, "hand");
  is_refused([](ThrowWish& w) { w.release = "never"; }, "never");
  is_refused([](ThrowWish& w) { w.action.clip = "thrw"; }, "thrw");
  is_refused([](ThrowWish& w) { w.asked.speed_m_s = kNaN; }, "speed_m_s");
  is_refused([](ThrowWish& w) { w.asked.elevation_rad = 2.0; }, "elevation_rad");
  is_refused([](ThrowWish& w) { w.asked.release_s = 9.0; }, "release_s");
  is_refused([](ThrowWish& w) { w.asked.release_s = 0.1; }, "leaves at");
  is_refused([](ThrowWish& w) { w.aim_in_world = glm::dvec3(kNaN); }, "aim");
  is_refused([](ThrowWish& w) { w.half_width_s = 0.0; }, "half width");
  is_refused([](ThrowWish& w) { w.ball.drag_1_m = -1.0; }, "ball");
  is_refused(
      [](ThrowWish& w) {
        w.aim_in_world = glm::dvec3(1.0);
        w.asked.azimuth_rad = 0.1;
      },
      "both");
  EXPECT_FALSE(engine.aim_ball(ann, 1, glm::dvec3(1.0)));  // Nothing is thrown.
  ASSERT_TRUE(engine.play(ann, throws()));
  EXPECT_FALSE(engine.aim_ball(ann, 1, glm::dvec3(1.0)));  // It has no aim.
}

}  // namespace
}  // namespace marey::engine
