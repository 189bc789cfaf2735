// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/foot_goals.h"

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {

std::vector<FootPlace> foot_places(const Motion& motion, const BodyMap& map, int side) {
  std::vector<RigidTransform> joints(motion.skeleton.joints.size());
  const auto turn = [&](HumanBone bone) {
    const auto joint = map.joint_of[index(bone)];
    return joint ? rotation_from_t_pose(map, joints, *joint) : glm::dquat(1, 0, 0, 0);
  };
  std::vector<FootPlace> out;
  out.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, joints);
    out.push_back({joints[index(map.leg(side).end)].translation,
                   turn(foot_bone(side)),
                   turn(toes_bone(side))});
  }
  return out;
}

std::vector<FootGoal> foot_goals(const Motion& motion,
                                 const BodyMap& map,
                                 int side,
                                 const FootGoalCourse& course) {
  const std::size_t count = motion.poses.size();
  MAREY_ASSERT(course.displaced_m.empty() || course.displaced_m.size() == count);
  MAREY_ASSERT(course.hold.empty() || course.hold.size() == count);
  MAREY_ASSERT(course.heel_may_rise.empty() || course.heel_may_rise.size() == count);
  MAREY_ASSERT(course.root_gives_way.empty() || course.root_gives_way.size() == count);
  std::vector<FootGoal> out;
  out.reserve(count);
  for (const FootPlace& place : foot_places(motion, map, side)) {
    const std::size_t t = out.size();
    FootGoal goal;
    goal.place = place;
    if (!course.displaced_m.empty()) goal.place.ankle_in_world += course.displaced_m[t];
    if (!course.hold.empty()) goal.hold = course.hold[t];
    if (!course.heel_may_rise.empty()) goal.heel_may_rise = course.heel_may_rise[t];
    if (!course.root_gives_way.empty()) goal.root_gives_way = course.root_gives_way[t];
    out.push_back(goal);
  }
  return out;
}

}  // namespace marey::retarget
