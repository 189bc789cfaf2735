// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/plant_near.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"

namespace marey::edit {
namespace {

constexpr int kWalkFrames = 360;  // 6 s

// Stands for 6 s while the body drifts by 2 cm/s, feet included. They count as standing.
EditState drifting() {
  EditState state = state_of(standing_motion(kWalkFrames, [](int frame, Pose& pose) {
    pose.root_in_world.x += 0.02 * frame / 60.0;
  }));
  for (FootContacts& foot : state.contacts.feet) {
    const std::vector<FrameRange> all{{0, kWalkFrames - 1}};
    foot.heel = all;
    foot.ball = all;
    foot.stance = all;
    foot.heel_up.clear();
  }
  return state;
}

TEST(PlantNear, FeetStandStillInTheZoneAndKeepTheirMotionFarFromIt) {
  const EditState before = drifting();
  EditState state = before;
  const FrameRange zone{150, 180};
  plant_feet_near(state, zone);
  for (const HumanBone bone : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    const auto old = joint_way(before.motion, bone);
    const auto way = joint_way(state.motion, bone);
    for (int t = 1; t < kWalkFrames; ++t) {
      const auto k = static_cast<std::size_t>(t);
      const double speed = glm::length(way[k] - way[k - 1]) * 60.0;
      if (t > zone.first && t <= zone.last) {
        EXPECT_LT(speed, 1e-4) << t;
        continue;
      }
      // Never faster than some times the drift, and as before beyond 0.5 s.
      EXPECT_LT(speed, 0.08) << t;
      if (t < zone.first - 30 || t > zone.last + 31) {
        EXPECT_NEAR(way[k].x - way[k - 1].x, old[k].x - old[k - 1].x, 1e-6) << t;
      }
    }
  }
}

// A foot steps, and its footprint before is planted 20 cm ahead of its own, so the swing
// is displaced beyond the leg's length.
TEST(PlantNear, SwingThatIsPlannedOutOfReachDoesNotSnapTheKneeStraight) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto map = retarget::map_body(skeleton);
  ASSERT_TRUE(map);
  Motion motion = standing_motion(120);
  LimbBender bender(skeleton, *map);
  for (int t = 40; t < 100; ++t) {
    Pose& pose = motion.poses[static_cast<std::size_t>(t)];
    const auto world = world_from_joints(skeleton, pose);
    const RigidTransform& foot = world[index(map->leg(1).end)];
    // Swings 0.22 m ahead and back.
    const double ahead_m = 0.22 * std::pow(std::sin(3.14159265 * (t - 40) / 60.0), 2.0);
    bender.move_end(
        3, foot.translation + glm::dvec3(0, 0.02, ahead_m), foot.rotation, pose);
  }
  EditState state = state_of(motion);
  FootContacts& right = state.contacts.feet[1];
  right.heel = right.ball = right.stance = {{0, 39}, {100, 119}};
  right.heel_up.clear();
  FootWays feet{foot_places(state, 0), foot_places(state, 1)};
  for (int t = 0; t < 40; ++t) {
    feet[1][static_cast<std::size_t>(t)].ankle_in_world.z += 0.2;
  }
  plant_feet_near(state, {20, 38}, feet);
  const double largest_rad_per_s2 = [&] {
    const auto knee = knee_angles(state.motion, 1);
    double out = 0.0;
    for (std::size_t t = 44; t < 96; ++t) {
      out = std::max(out, std::abs(knee[t + 1] - 2.0 * knee[t] + knee[t - 1]) * 3600.0);
    }
    return out;
  }();
  // The swing itself has 12. A leg that is clamped straight within a frame has 475.
  EXPECT_LT(largest_rad_per_s2, 60.0);
}

}  // namespace
}  // namespace marey::edit
