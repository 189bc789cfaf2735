// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/level.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "edit/ops/path.h"
#include "edit/state/lineage.h"
#include "edit/state/move_state.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"

namespace marey::edit {
namespace {

using testing::Dice;
using testing::synthetic_walk;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kLevelSeeds = 20;

/// A walk of 5 m round a bend, on the floor Y = 0.
EditState round_walk() {
  auto walk = synthetic_walk(330, 60.0).motion;
  const auto straight = make_edit_state(std::move(walk));
  EXPECT_TRUE(straight);
  PathOp bend;
  bend.turn_rad = 0.8 * std::numbers::pi;
  OpScene<PathOp> scene(bend);
  auto bent = scene.run(apply_path, *straight);
  EXPECT_TRUE(bent);
  return *std::move(bent);
}

/// Tilts a motion about an axis on the floor through the origin, and raises it.
EditState tilted(const EditState& level,
                 const glm::dquat& tilt,
                 double raised_m,
                 std::uint64_t seed = 0,
                 double noise_rad = 0.0) {
  Motion motion = level.motion;
  if (noise_rad > 0.0) add_motion_noise(motion, seed, noise_rad, 0.001);
  for (Pose& pose : motion.poses) {
    pose.root_in_world = tilt * pose.root_in_world + glm::dvec3(0.0, raised_m, 0.0);
    pose.parent_from_joint[0] = tilt * pose.parent_from_joint[0];
  }
  auto state = make_edit_state(std::move(motion));
  EXPECT_TRUE(state);
  return *std::move(state);
}

glm::dquat tilt_about(double heading_rad, double angle_rad) {
  return glm::angleAxis(angle_rad,
                        glm::dvec3(std::sin(heading_rad), 0.0, std::cos(heading_rad)));
}

/// Angle between +Y and the true up axis of a motion that was tilted and levelled.
double remaining_tilt_rad(const EditState& source,
                          const glm::dquat& tilt,
                          const EditState& levelled) {
  const glm::dquat turn = levelled.motion.poses[100].parent_from_joint[0] *
                          glm::conjugate(source.motion.poses[100].parent_from_joint[0]);
  const glm::dvec3 up = turn * tilt * glm::dvec3(0.0, 1.0, 0.0);
  return std::atan2(std::hypot(up.x, up.z), up.y);
}

/// Mean height of an ankle over its stances, minus the same in the truth.
double height_error_m(const EditState& truth, const EditState& levelled) {
  double sum = 0.0;
  int frames = 0;
  const auto old = joint_way(truth.motion, HumanBone::kLeftFoot);
  const auto now = joint_way(levelled.motion, HumanBone::kLeftFoot);
  for (const FrameRange& run : truth.contacts.feet[0].heel) {
    for (int t = run.first; t <= run.last; ++t, ++frames) {
      sum += now[static_cast<std::size_t>(t)].y - old[static_cast<std::size_t>(t)].y;
    }
  }
  return sum / frames;
}

TEST(ApplyLevel, RecoversAKnownTiltAndHeight) {
  const EditState truth = round_walk();
  Dice dice(3);
  for (int k = 0; k < kLevelSeeds; ++k) {
    const glm::dquat tilt = tilt_about(dice.between(0.0, 2.0 * std::numbers::pi),
                                       dice.between(0.0, 5.0) * kDegree);
    const EditState source = tilted(truth, tilt, dice.between(-0.5, 0.5));
    OpScene<LevelOp> scene({});
    const auto made = scene.run(apply_level, source);
    ASSERT_TRUE(made) << made.error().message();
    // Contacts of the simulation are known to some frames, in which a foot rolls.
    EXPECT_LT(remaining_tilt_rad(source, tilt, *made), 0.05 * kDegree);
    EXPECT_NEAR(height_error_m(truth, *made), 0.0, 0.003 /* m */);
    EXPECT_FALSE(scene.has_finding("tilt_unobserved"));
  }
}

TEST(ApplyLevel, RecoversTiltAndHeightUnderNoise) {
  const EditState truth = round_walk();
  Dice dice(4);
  for (std::uint64_t seed = 1; seed <= kLevelSeeds; ++seed) {
    const glm::dquat tilt = tilt_about(dice.between(0.0, 2.0 * std::numbers::pi),
                                       dice.between(0.0, 5.0) * kDegree);
    const EditState source = tilted(truth, tilt, dice.between(-0.5, 0.5), seed, 0.002);
    OpScene<LevelOp> scene({});
    const auto made = scene.run(apply_level, source);
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_LT(remaining_tilt_rad(source, tilt, *made), 0.1 * kDegree) << seed;
    EXPECT_NEAR(height_error_m(truth, *made), 0.0, 0.005 /* m */) << seed;
  }
}

TEST(ApplyLevel, ALevelMotionStaysAsItIs) {
  const EditState truth = round_walk();
  OpScene<LevelOp> scene({});
  const auto made = scene.run(apply_level, truth);
  ASSERT_TRUE(made);
  EXPECT_LT(scene.figure("tilt_deg"), 0.1);
  EXPECT_NEAR(scene.figure("raised_mm"), 0.0, 3.0);
  EXPECT_EQ(ops_of(made->lineage, 10).size(), ops_of(truth.lineage, 10).size() + 1);
}

TEST(ApplyLevel, PutsTheFloorAtTheGivenHeight) {
  const EditState truth = round_walk();
  LevelOp op;
  op.floor_height_m = 0.25;
  op.tilt = false;
  OpScene<LevelOp> scene(op);
  const auto made = scene.run(apply_level, truth);
  ASSERT_TRUE(made);
  EXPECT_NEAR(height_error_m(truth, *made), 0.25, 0.003 /* m */);
  EXPECT_EQ(scene.figure("tilt_deg"), 0.0);
}

TEST(ApplyLevel, AStraightWalkIsLevelledAlongItsLineOnly) {
  auto walk = synthetic_walk(300, 60.0).motion;
  const auto truth = make_edit_state(std::move(walk));
  ASSERT_TRUE(truth);
  // About X: the walk climbs. About Z: it leans to one side, which is not observable.
  const glm::dquat climb = tilt_about(0.5 * std::numbers::pi, 0.04);
  const EditState climbing = tilted(*truth, climb, 0.1);
  OpScene<LevelOp> scene({});
  const auto made = scene.run(apply_level, climbing);
  ASSERT_TRUE(made);
  EXPECT_TRUE(scene.has_finding("tilt_unobserved"));
  EXPECT_LT(remaining_tilt_rad(climbing, climb, *made), 0.15 * kDegree);
  const glm::dquat lean = tilt_about(0.0, 0.04);
  const EditState leaning = tilted(*truth, lean, 0.1);
  const auto left = scene.run(apply_level, leaning);
  ASSERT_TRUE(left);
  EXPECT_TRUE(scene.has_finding("tilt_unobserved"));
  EXPECT_NEAR(remaining_tilt_rad(leaning, lean, *left), 0.04, 0.003);
}

TEST(ApplyLevel, ConstraintsMoveWithTheMotion) {
  const EditState truth = round_walk();
  EditState source = tilted(truth, tilt_about(1.0, 0.05), 0.2);
  Constraint touch;
  touch.id = "touch";
  touch.point.segment = "leftHand";
  const glm::dvec3 hand = joint_way(source.motion, HumanBone::kLeftHand)[100];
  touch.goal = DistanceToPoint{0.0, hand};
  source.constraints.constraints.push_back(touch);
  OpScene<LevelOp> scene({});
  const auto made = scene.run(apply_level, source);
  ASSERT_TRUE(made);
  const auto& goal =
      std::get<DistanceToPoint>(made->constraints.constraints.front().goal);
  EXPECT_LT(
      glm::distance(goal.p_in_world, joint_way(made->motion, HumanBone::kLeftHand)[100]),
      1e-9 /* m */);
}

TEST(ApplyLevel, AMotionWithoutStancesIsRefused) {
  auto walk = synthetic_walk(60, 60.0).motion;
  for (std::size_t t = 0; t < walk.poses.size(); ++t) {
    walk.poses[t].root_in_world.y += 3.0 * static_cast<double>(t) / 60.0;
    walk.poses[t].parent_from_joint = walk.poses[0].parent_from_joint;
  }
  const auto flying = make_edit_state(std::move(walk));
  ASSERT_TRUE(flying);
  OpScene<LevelOp> scene({});
  EXPECT_FALSE(scene.run(apply_level, *flying));
  scene.op.blend_s = 0.1;
  EXPECT_FALSE(scene.run(apply_level, *flying));
}

}  // namespace
}  // namespace marey::edit
