// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/path.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/travel_path.h"
#include "edit/state/lineage.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"

namespace marey::edit {
namespace {

using B = HumanBone;
using testing::synthetic_walk;
using testing::SyntheticWalk;

constexpr double kRightAngle = 0.5 * std::numbers::pi;
constexpr double kWalkRate_hz = 60.0;
constexpr int kWalkFrames = 240;  // 3.6 m.
constexpr int kSeeds = 20;

EditState walk_state(std::uint64_t seed = 0, double noise_rad = 0.0) {
  SyntheticWalk walk = synthetic_walk(kWalkFrames, kWalkRate_hz);
  if (noise_rad > 0.0) add_motion_noise(walk.motion, seed, noise_rad, 0.001);
  auto state = make_edit_state(std::move(walk.motion));
  EXPECT_TRUE(state);
  return *std::move(state);
}

double largest_move_m(const Motion& a, const Motion& b) {
  double largest = 0.0;
  for (std::size_t t = 0; t < a.poses.size(); ++t) {
    const auto p = world_from_joints(a.skeleton, a.poses[t]);
    const auto q = world_from_joints(b.skeleton, b.poses[t]);
    for (std::size_t j = 0; j < p.size(); ++j) {
      largest = std::max(largest, glm::distance(p[j].translation, q[j].translation));
    }
  }
  return largest;
}

/// Speed of ankle and toe joint while they rest by the simulation's truth. [cm/s]
double true_slide_cm_per_s(const Motion& motion) {
  const SyntheticWalk truth = synthetic_walk(kWalkFrames, kWalkRate_hz);
  double way_m = 0.0;
  int steps = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto ankle = joint_way(motion, side == 0 ? B::kLeftFoot : B::kRightFoot);
    const auto ball = joint_way(motion, side == 0 ? B::kLeftToes : B::kRightToes);
    for (const auto& [way, rests] : {std::pair{&ankle, &truth.feet[side].heel},
                                     std::pair{&ball, &truth.feet[side].ball}}) {
      for (std::size_t t = 1; t < way->size(); ++t) {
        if (!(*rests)[t] || !(*rests)[t - 1]) continue;
        way_m += glm::distance((*way)[t], (*way)[t - 1]);
        ++steps;
      }
    }
  }
  return 100.0 * way_m / steps * kWalkRate_hz;
}

/// Largest distance from the rigid image of the same stance: two frames of ankle and toe
/// joint give the image, all frames must follow it.
double print_error_m(const EditState& source, const Motion& made) {
  double worst = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const B foot = side == 0 ? B::kLeftFoot : B::kRightFoot;
    const B toes = side == 0 ? B::kLeftToes : B::kRightToes;
    const std::array old{joint_way(source.motion, foot), joint_way(source.motion, toes)};
    const std::array now{joint_way(made, foot), joint_way(made, toes)};
    for (const FrameRange& run : source.contacts.feet[side].stance) {
      const auto middle = static_cast<std::size_t>((run.first + run.last) / 2);
      const glm::dvec3 u = old[1][middle] - old[0][middle];
      const glm::dvec3 v = now[1][middle] - now[0][middle];
      const double turn_rad = std::atan2(v.x, v.z) - std::atan2(u.x, u.z);
      const glm::dquat turn = glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0));
      for (std::size_t k = 0; k < 2; ++k) {
        for (auto t = static_cast<std::size_t>(run.first);
             t <= static_cast<std::size_t>(run.last);
             ++t) {
          const glm::dvec3 image = now[0][middle] + turn * (old[k][t] - old[0][middle]);
          worst = std::max(worst, glm::distance(image, now[k][t]));
        }
      }
    }
  }
  return worst;
}

std::vector<std::pair<std::string, PathOp>> path_cases() {
  PathOp bent;
  bent.turn_rad = kRightAngle;
  PathOp right = bent;
  right.turn_rad = -kRightAngle;
  PathOp longer;
  longer.length = 1.2;
  PathOp shorter;
  shorter.length = 0.8;
  PathOp curved;
  curved.points_xz_m = {{0.0, -0.2}, {0.3, 0.9}, {-0.3, 2.3}, {0.0, 3.4}};
  return {{"left", bent},
          {"right", right},
          {"longer", longer},
          {"shorter", shorter},
          {"S", curved}};
}

TEST(ApplyPath, ThePathAsItIsChangesNothing) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const EditState source = walk_state(seed, 0.005);
    OpScene<PathOp> scene({});
    const auto made = scene.run(apply_path, source);
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_LT(largest_move_m(source.motion, made->motion), 1e-9 /* m */);
  }
}

TEST(ApplyPath, StandingFeetDoNotSlideOnAnyPath) {
  const EditState source = walk_state();
  ASSERT_LT(true_slide_cm_per_s(source.motion), 1e-6);
  for (const auto& [name, op] : path_cases()) {
    OpScene<PathOp> scene(op);
    const auto made = scene.run(apply_path, source);
    ASSERT_TRUE(made) << name << made.error().message();
    EXPECT_LT(true_slide_cm_per_s(made->motion), 0.3) << name;
    EXPECT_EQ(scene.figure("unreachable_frames"), 0.0) << name;
  }
}

TEST(ApplyPath, FootprintsAreRigidImagesUnderNoise) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const EditState source = walk_state(seed, 0.003);
    for (const auto& [name, op] : path_cases()) {
      OpScene<PathOp> scene(op);
      const auto made = scene.run(apply_path, source);
      ASSERT_TRUE(made) << name << made.error().message();
      EXPECT_LT(print_error_m(source, made->motion), 1e-7) << name << seed;
    }
  }
}

TEST(ApplyPath, KneesAreAtMostAFifthFaster) {
  const EditState source = walk_state();
  for (const auto& [name, op] : path_cases()) {
    OpScene<PathOp> scene(op);
    const auto made = scene.run(apply_path, source);
    ASSERT_TRUE(made) << name;
    EXPECT_LT(knee_speed(made->motion), 1.2 * knee_speed(source.motion)) << name;
  }
}

// The truth is the formula of a circle: a footprint at the way s along the straight path,
// x to its left, goes to the frame of the arc at s.
TEST(ApplyPath, FootprintsOfABentStraightWalkLieOnTheArc) {
  const EditState source = walk_state();
  OpScene<PathOp> scene([] {
    PathOp op;
    op.turn_rad = kRightAngle;
    return op;
  }());
  const auto made = scene.run(apply_path, source);
  ASSERT_TRUE(made);
  const double length_m = scene.figure("length_m");
  const double radius_m = length_m / kRightAngle;
  const double start_z = joint_way(source.motion, B::kHips).front().z;
  for (std::size_t side = 0; side < 2; ++side) {
    const B foot = side == 0 ? B::kLeftFoot : B::kRightFoot;
    const auto old = joint_way(source.motion, foot);
    const auto now = joint_way(made->motion, foot);
    const auto hips = joint_way(source.motion, B::kHips);
    for (const FrameRange& run : source.contacts.feet[side].stance) {
      const double hips_z =
          0.5 * (hips[static_cast<std::size_t>((run.first + run.last) / 2)].z +
                 hips[static_cast<std::size_t>((run.first + run.last + 1) / 2)].z);
      const double angle = (hips_z - start_z) / radius_m;
      const auto t = static_cast<std::size_t>(run.first);
      const glm::dvec3 centre(
          radius_m * (1.0 - std::cos(angle)), 0.0, start_z + radius_m * std::sin(angle));
      const glm::dvec3 image = centre + glm::angleAxis(angle, glm::dvec3(0, 1, 0)) *
                                            (old[t] - glm::dvec3(0.0, 0.0, hips_z));
      EXPECT_LT(glm::distance(image, now[t]), 1e-3 /* m */) << side << " " << run.first;
    }
  }
}

TEST(ApplyPath, ADrawnPathIsFollowedThroughItsPoints) {
  const EditState source = walk_state();
  OpScene<PathOp> scene(path_cases().back().second);
  const auto made = scene.run(apply_path, source);
  ASSERT_TRUE(made);
  const auto hips = joint_way(made->motion, B::kHips);
  for (const glm::dvec2& point : std::get<PathOp>(scene.op.parameters).points_xz_m) {
    double nearest = 1e9;
    for (const glm::dvec3& p : hips) {
      nearest = std::min(nearest, glm::distance(glm::dvec2(p.x, p.z), point));
    }
    // The hips sway about the path, and frames are 15 mm apart.
    EXPECT_LT(nearest, 0.02 /* m */);
  }
}

TEST(ApplyPath, StraightRemovesTheTurnOfABentWalk) {
  const EditState source = walk_state();
  PathOp bend;
  bend.turn_rad = kRightAngle;
  OpScene<PathOp> bending(bend);
  const auto bent = bending.run(apply_path, source);
  ASSERT_TRUE(bent);
  PathOp straighten;
  straighten.straight = true;
  OpScene<PathOp> straightening(straighten);
  const auto back = straightening.run(apply_path, *bent);
  ASSERT_TRUE(back);
  const TravelPath path = find_travel_path(*back);
  const auto [low, high] =
      std::minmax_element(path.heading_rad.begin(), path.heading_rad.end());
  // The low-pass straightens the ends of an arc: there a part of the turn is not seen.
  EXPECT_LT(*high - *low, 0.1 /* rad */);
}

TEST(ApplyPath, FramesBeforeTheSpanStayAndLaterOnesFollowRigidly) {
  const EditState source = walk_state();
  PathOp op;
  op.turn_rad = 0.5;
  OpScene<PathOp> scene(op);
  scene.op.span = {AtFrame{80}, AtFrame{160}};
  const auto made = scene.run(apply_path, source);
  ASSERT_TRUE(made) << made.error().message();
  for (std::size_t t = 0; t < 75; ++t) {
    EXPECT_EQ(made->motion.poses[t].root_in_world, source.motion.poses[t].root_in_world);
    EXPECT_TRUE(made->motion.poses[t].parent_from_joint ==
                source.motion.poses[t].parent_from_joint);
  }
  const auto old = joint_way(source.motion, B::kHead);
  const auto now = joint_way(made->motion, B::kHead);
  const glm::dquat turn = glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
  for (std::size_t t = 190; t < now.size(); ++t) {
    EXPECT_LT(glm::distance(turn * (old[t] - old[189]), now[t] - now[189]), 1e-9);
  }
  EXPECT_TRUE(ops_of(made->lineage, 20).empty());
  EXPECT_EQ(ops_of(made->lineage, 120).size(), 1U);
}

TEST(ApplyPath, APointOfAConstraintMovesWithTheFrameAtItsTime) {
  EditState source = walk_state();
  Constraint touch;
  touch.id = "touch";
  touch.point.segment = "leftHand";
  touch.activation.start_s = 1.9;
  touch.activation.stop_s = 2.1;
  // A point that is fixed to the head at 2 s.
  const glm::dvec3 from_head(0.1, 0.0, 0.2);
  touch.goal = DistanceToPoint{0.0, joint_way(source.motion, B::kHead)[120] + from_head};
  source.constraints.constraints.push_back(touch);
  PathOp op;
  op.turn_rad = kRightAngle;
  OpScene<PathOp> scene(op);
  const auto made = scene.run(apply_path, source);
  ASSERT_TRUE(made);
  const glm::dquat turn = made->motion.poses[120].parent_from_joint[0] *
                          glm::conjugate(source.motion.poses[120].parent_from_joint[0]);
  const auto& goal =
      std::get<DistanceToPoint>(made->constraints.constraints.front().goal);
  const glm::dvec3 head = joint_way(made->motion, B::kHead)[120];
  // The hips, and the head with them, may have sunk.
  const glm::dvec3 apart = goal.p_in_world - (head + turn * from_head);
  EXPECT_LT(std::hypot(apart.x, apart.z), 1e-9);
  EXPECT_FALSE(scene.has_finding("constraint_travel"));
  source.constraints.constraints.front().activation = {};
  ASSERT_TRUE(scene.run(apply_path, source));
  EXPECT_TRUE(scene.has_finding("constraint_travel"));
}

TEST(ApplyPath, ALengthThatStepsCannotReachIsRefusedWithTheRange) {
  const EditState source = walk_state();
  PathOp op;
  op.length = 1.5;
  OpScene<PathOp> scene(op);
  const auto made = scene.run(apply_path, source);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().cause.find("2.53 m to 4.71 m"), std::string::npos)
      << made.error().cause;
}

TEST(ApplyPath, AMotionThatStaysInPlaceIsRefused) {
  SyntheticWalk walk = synthetic_walk(120, kWalkRate_hz);
  for (Pose& pose : walk.motion.poses) pose = walk.motion.poses.front();
  const auto source = make_edit_state(std::move(walk.motion));
  ASSERT_TRUE(source);
  OpScene<PathOp> scene({});
  const auto made = scene.run(apply_path, *source);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().cause.find("0.00 m"), std::string::npos) << made.error().cause;
}

TEST(ApplyPath, KeysWithoutMeaningAreRefused) {
  const EditState source = walk_state();
  OpScene<PathOp> groups({});
  groups.op.groups = {EditGroup::kRoot};
  EXPECT_FALSE(groups.run(apply_path, source));
  OpScene<PathOp> blend({});
  blend.op.blend_s = 0.2;
  EXPECT_FALSE(blend.run(apply_path, source));
  OpScene<PathOp> both(path_cases().back().second);
  std::get<PathOp>(both.op.parameters).length = 1.1;
  EXPECT_FALSE(both.run(apply_path, source));
}

TEST(ApplyPath, AFastTurnOnBothFeetIsReported) {
  const EditState source = walk_state();
  PathOp op;
  op.turn_rad = 5.0;
  OpScene<PathOp> scene(op);
  ASSERT_TRUE(scene.run(apply_path, source));
  EXPECT_TRUE(scene.has_finding("turn_rate"));
  op.turn_rad = kRightAngle;
  OpScene<PathOp> wide(op);
  ASSERT_TRUE(wide.run(apply_path, source));
  EXPECT_FALSE(wide.has_finding("turn_rate"));
}

}  // namespace
}  // namespace marey::edit
