// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include "edit/state/bend_limb.h"
#include "edit/state/edit_state.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::edit {

/// An average adult that stands at 60 Hz with slightly bent knees and hanging arms.
/// `change` alters the pose of each frame.
inline Motion standing_motion(
    int frames, const std::function<void(int, Pose&)>& change = [](int, Pose&) {}) {
  Motion out{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const auto map = retarget::map_body(out.skeleton);
  EXPECT_TRUE(map);
  const auto rest = world_from_joints(out.skeleton, rest_pose(out.skeleton));
  constexpr double kDown_rad = 1.3;
  constexpr double kElbow_rad = 0.3;
  constexpr double kSink_m = 0.03;
  for (int frame = 0; frame < frames; ++frame) {
    Pose pose = rest_pose(out.skeleton);
    const auto turn = [&](HumanBone bone, double angle, const glm::dvec3& axis) {
      pose.parent_from_joint[index(*out.skeleton.find(bone))] =
          glm::angleAxis(angle, axis);
    };
    turn(HumanBone::kLeftUpperArm, -kDown_rad, {0, 0, 1});
    turn(HumanBone::kRightUpperArm, kDown_rad, {0, 0, 1});
    turn(HumanBone::kLeftLowerArm, -kElbow_rad, {0, 1, 0});
    turn(HumanBone::kRightLowerArm, kElbow_rad, {0, 1, 0});
    pose.root_in_world.y -= kSink_m;
    LimbBender bender(out.skeleton, *map);
    for (int side = 0; side < 2; ++side) {
      const RigidTransform& foot = rest[index(map->leg(side).end)];
      bender.move_end(2 + side, foot.translation, foot.rotation, pose);
    }
    change(frame, pose);
    out.poses.push_back(std::move(pose));
  }
  return out;
}

/// The state of a motion; the test fails if there is none.
inline EditState state_of(Motion motion) {
  auto state = make_edit_state(std::move(motion));
  EXPECT_TRUE(state) << (state ? "" : state.error().message());
  return *std::move(state);
}

/// Returns true if both poses agree to the bit.
inline bool same_pose(const Pose& a, const Pose& b) {
  return a.root_in_world == b.root_in_world && a.parent_from_joint == b.parent_from_joint;
}

/// Returns the largest distance between joints of two motions in one frame. [m]
inline double pose_distance_m(const Motion& a, const Motion& b, int frame) {
  const auto t = static_cast<std::size_t>(frame);
  const auto p = world_from_joints(a.skeleton, a.poses[t]);
  const auto q = world_from_joints(b.skeleton, b.poses[t]);
  double largest = 0.0;
  for (std::size_t j = 0; j < p.size(); ++j) {
    largest = std::max(largest, glm::distance(p[j].translation, q[j].translation));
  }
  return largest;
}

}  // namespace marey::edit
