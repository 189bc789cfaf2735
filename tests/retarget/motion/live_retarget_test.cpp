// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/live_retarget.h"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/body/body_map.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kRate_hz = 60.0;

struct Dressed {
  Motion motion;
  std::vector<std::array<StandingFoot, 2>> standing;
};

Dressed dress(const Motion& source,
              const Skeleton& avatar,
              const LiveRetargetOptions& options = {}) {
  auto live = LiveRetarget::make(source.skeleton, avatar, options);
  EXPECT_TRUE(live);
  Dressed out{{avatar, source.rate, 0, {}}, {}};
  for (const Pose& pose : source.poses) {
    out.motion.poses.emplace_back();
    live->step(pose, 1.0 / source.rate.hz, out.motion.poses.back());
    out.standing.push_back(live->standing());
  }
  return out;
}

std::vector<glm::dvec3> path_of(const Motion& motion, B bone) {
  std::vector<glm::dvec3> out;
  const JointIndex joint = *motion.skeleton.find(bone);
  for (const Pose& pose : motion.poses) {
    out.push_back(world_from_joints(motion.skeleton, pose)[index(joint)].translation);
  }
  return out;
}

// A foot on its ball in consecutive frames keeps that position; flat, its ankle too.
TEST(LiveRetarget, FeetThatStandStandStill) {
  const Motion walk = testing::synthetic_walk(200, kRate_hz, 0.002, 0.001).motion;
  for (const Skeleton& avatar :
       {testing::child(), testing::giant(), testing::long_legs(), walk.skeleton}) {
    const Dressed out = dress(walk, avatar);
    int stood = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto ankle = path_of(out.motion, side == 0 ? B::kLeftFoot : B::kRightFoot);
      const auto ball = path_of(out.motion, side == 0 ? B::kLeftToes : B::kRightToes);
      for (std::size_t t = 10; t < ball.size(); ++t) {
        const StandingFoot& now = out.standing[t][side];
        // While a foot lies down, in its first 80 ms, only its bearing joint is still.
        bool long_flat = true;
        for (std::size_t k = t - 6; k <= t; ++k) {
          const StandingFoot& then = out.standing[k][side];
          long_flat = long_flat && then.heel && then.ball;
        }
        if (!long_flat) continue;
        ++stood;
        EXPECT_LT(glm::distance(ankle[t], ankle[t - 1]), 1e-6) << side << " " << t;
        EXPECT_LT(glm::distance(ball[t], ball[t - 1]), 1e-6) << side << " " << t;
        EXPECT_TRUE(now.heel);
      }
    }
    EXPECT_GT(stood, 60);
  }
}

TEST(LiveRetarget, NeverPutsAFootThroughTheFloor) {
  Motion walk = testing::synthetic_walk(200, kRate_hz).motion;
  for (std::size_t t = 0; t < walk.poses.size(); ++t) {
    walk.poses[t].root_in_world.y -= 0.01 * std::sin(0.1 * static_cast<double>(t));
  }
  for (const Skeleton& avatar : {testing::child(), testing::giant()}) {
    const BodyMap map = *map_body(avatar);
    const Dressed out = dress(walk, avatar);
    Contacts none;
    none.frame_count = static_cast<int>(out.motion.poses.size());
    EXPECT_LT(measure_feet(out.motion, map, none).max_penetration_mm, 1.0);
    for (std::size_t side = 0; side < 2; ++side) {
      for (const glm::dvec3& p :
           path_of(out.motion, side == 0 ? B::kLeftFoot : B::kRightFoot)) {
        EXPECT_GT(p.y, map.feet[side].ankle_height_m - 1e-3);
      }
      for (const glm::dvec3& p :
           path_of(out.motion, side == 0 ? B::kLeftToes : B::kRightToes)) {
        EXPECT_GT(p.y, map.feet[side].ball_height_m - 1e-3);
      }
    }
  }
}

// Future frames are unknown: a foot may stop at once, but no joint jumps.
TEST(LiveRetarget, MovesContinuously) {
  const Motion walk = testing::synthetic_walk(200, kRate_hz, 0.002, 0.001).motion;
  const Skeleton avatar = testing::long_legs();
  const double scale =
      map_body(avatar)->leg_length_m / map_body(walk.skeleton)->leg_length_m;
  const Dressed out = dress(walk, avatar);
  for (const B bone :
       {B::kHips, B::kLeftFoot, B::kRightFoot, B::kLeftLowerLeg, B::kRightToes}) {
    const auto before = path_of(walk, bone);
    const auto after = path_of(out.motion, bone);
    double fastest_m = 0.0;
    for (std::size_t t = 1; t < before.size(); ++t) {
      fastest_m = std::max(fastest_m, glm::distance(before[t], before[t - 1]));
    }
    for (std::size_t t = 1; t < after.size(); ++t) {
      EXPECT_LT(glm::distance(after[t], after[t - 1]), 1.3 * scale * fastest_m)
          << name(bone) << " " << t;
    }
  }
}

TEST(LiveRetarget, IsRetargetMotionWhereFeetAreLeftAlone) {
  const Motion walk = testing::synthetic_walk(60, kRate_hz).motion;
  LiveRetargetOptions options;
  options.hold_feet = false;
  RetargetOptions offline;
  offline.adapt_ground = false;
  const Dressed live = dress(walk, walk.skeleton, options);
  const auto whole = retarget_motion(walk, walk.skeleton, offline);
  ASSERT_TRUE(whole);
  for (const B bone : {B::kHips, B::kHead, B::kLeftHand, B::kRightToes}) {
    const auto a = path_of(live.motion, bone);
    const auto b = path_of(whole->motion, bone);
    for (std::size_t t = 0; t < a.size(); ++t) {
      EXPECT_LT(glm::distance(a[t], b[t]), 1e-9) << name(bone);
    }
  }
}

TEST(LiveRetarget, RepeatsItsResultsAfterAReset) {
  const Motion walk = testing::synthetic_walk(80, kRate_hz, 0.002, 0.001).motion;
  const Skeleton avatar = testing::giant();
  auto live = LiveRetarget::make(walk.skeleton, avatar);
  ASSERT_TRUE(live);
  std::vector<Pose> first;
  Pose out;
  for (const Pose& pose : walk.poses) {
    live->step(pose, 1.0 / kRate_hz, out);
    first.push_back(out);
  }
  live->reset();
  for (std::size_t t = 0; t < walk.poses.size(); ++t) {
    live->step(walk.poses[t], 1.0 / kRate_hz, out);
    EXPECT_EQ(out.root_in_world, first[t].root_in_world);
    EXPECT_EQ(out.parent_from_joint, first[t].parent_from_joint);
  }
}

TEST(LiveRetarget, AllocatesNothingOnceItRuns) {
  const Motion walk = testing::synthetic_walk(80, kRate_hz).motion;
  auto live = LiveRetarget::make(walk.skeleton, testing::giant());
  ASSERT_TRUE(live);
  Pose out;
  live->step(walk.poses[0], 1.0 / kRate_hz, out);
  const long before = testing::allocations();
  for (const Pose& pose : walk.poses) live->step(pose, 1.0 / kRate_hz, out);
  EXPECT_EQ(testing::allocations(), before);
}

TEST(LiveRetarget, ABodyWithoutLegsIsDeclined) {
  const Skeleton avatar = testing::without(testing::giant(), B::kLeftLowerLeg);
  const auto live = LiveRetarget::make(testing::child(), avatar);
  ASSERT_FALSE(live);
  EXPECT_EQ(live.error().where, "avatar");
}

}  // namespace
}  // namespace marey::retarget
