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

}  // namespace
}  // namespace marey::engine
