// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_track.h"

#include <cstddef>
#include <vector>

#include "core/base/assert.h"
#include "core/human/centre_of_mass.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

void add_sole_points(const BodyMap& map,
                     std::span<const RigidTransform> world_from_joint,
                     int side,
                     SoleTrack& sole) {
  const FootMap& foot = map.feet[static_cast<std::size_t>(side)];
  const JointIndex ankle = map.leg(side).end;
  const auto toes =
      map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
  const glm::dquat turn = rotation_from_t_pose(map, world_from_joint, ankle);
  const glm::dquat toes_turn =
      toes ? rotation_from_t_pose(map, world_from_joint, *toes) : turn;
  const glm::dvec3 at = world_from_joint[index(ankle)].translation;
  const glm::dvec3 toe_joint = at + turn * foot.ball_from_ankle_in_t_pose;
  const glm::dvec3 to_sole(0.0, -foot.ball_height_m, 0.0);
  sole.heel_in_world.push_back(at + turn * foot.heel_from_ankle_in_t_pose);
  sole.ball_in_world.push_back(toe_joint + toes_turn * to_sole);
  sole.tip_in_world.push_back(toe_joint + toes_turn * foot.tip_from_ball_in_t_pose);
}

}  // namespace

BodyTrack body_track(const Motion& motion,
                     const BodyMap& map,
                     std::span<const PointMass> masses) {
  BodyTrack track;
  track.rate = motion.rate;
  for (const PointMass& mass : masses) track.mass_kg += mass.mass_kg;
  MAREY_ASSERT(track.mass_kg > 0.0);
  track.com_in_world.reserve(motion.poses.size());
  for (SoleTrack& sole : track.soles) {
    sole.heel_in_world.reserve(motion.poses.size());
    sole.ball_in_world.reserve(motion.poses.size());
    sole.tip_in_world.reserve(motion.poses.size());
  }
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    track.com_in_world.push_back(centre_of_mass(masses, world_from_joint));
    for (const int side : {0, 1}) {
      add_sole_points(
          map, world_from_joint, side, track.soles[static_cast<std::size_t>(side)]);
    }
  }
  return track;
}

}  // namespace marey::retarget
