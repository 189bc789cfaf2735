// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/plan_feet.h"

#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::retarget {
namespace {

// Returns the foot over the motion, above a floor at Y = 0.
std::vector<FootPlace> foot_places(const Motion& motion,
                                   const BodyMap& map,
                                   std::size_t side,
                                   double floor_height_m) {
  const JointIndex ankle = map.leg(static_cast<int>(side)).end;
  const auto toes = map.joint_of[index(toes_bone(static_cast<int>(side)))];
  std::vector<FootPlace> out;
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    FootPlace place{
        world[index(ankle)].translation, rotation_from_t_pose(map, world, ankle), {}};
    place.ankle_in_world.y -= floor_height_m;
    place.toes = toes ? rotation_from_t_pose(map, world, *toes) : place.foot;
    out.push_back(place);
  }
  return out;
}

}  // namespace

std::array<FloorFoot, 2> plan_feet(const Motion& motion,
                                   const BodyMap& map,
                                   const Contacts& contacts,
                                   double floor_height_m,
                                   const Floor* floor) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(motion.poses.size()));
  MAREY_ASSERT(motion.rate.hz > 0.0);
  std::array<std::vector<FootPlace>, 2> flat;
  for (std::size_t side = 0; side < 2; ++side) {
    flat[side] = plan_foot_path(foot_places(motion, map, side, floor_height_m),
                                contacts.feet[side],
                                map.feet[side],
                                map.leg_length_m,
                                motion.rate);
  }
  const Floor level;
  std::array<FloorFoot, 2> feet = stand_feet_on(floor == nullptr ? level : *floor,
                                                flat,
                                                contacts,
                                                map,
                                                motion.rate,
                                                motion.first_frame);
  for (FloorFoot& foot : feet) {
    for (FootPlace& place : foot.places) place.ankle_in_world.y += floor_height_m;
  }
  return feet;
}

}  // namespace marey::retarget
