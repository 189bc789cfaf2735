// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/reach_with_body.h"

#include <cstddef>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/character/make_character.h"

namespace marey::edit {
namespace {

constexpr double kReachPrecision_m = 1e-5;
const char* const kReachId = "reach";

ConstraintSet reach_constraints(HumanBone bone) {
  ConstraintSet set;
  Constraint reach;
  reach.id = kReachId;
  reach.point.segment = name(bone);
  reach.goal = DistanceToPoint{};
  reach.precision_m = kReachPrecision_m;
  set.constraints.push_back(std::move(reach));
  for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    if (foot == bone) continue;
    Constraint stands;
    stands.id = name(foot);
    stands.point.segment = name(foot);
    stands.goal = Support{glm::dvec3(0.0), glm::dquat(1, 0, 0, 0), false};
    set.constraints.push_back(std::move(stands));
  }
  return set;
}

}  // namespace

Result<BodyReach> reach_with_body(HumanBone bone,
                                  const std::vector<glm::dvec3>& path_in_world,
                                  const FrameRange& frames,
                                  EditState& state) {
  MAREY_ASSERT(path_in_world.size() == state.motion.poses.size());
  const Skeleton& skeleton = state.motion.skeleton;
  const auto character = retarget::make_character("body", skeleton, state.map);
  if (!character) return character.error();
  auto adapter = retarget::Adapter::make(*character, reach_constraints(bone), {});
  if (!adapter) return adapter.error();
  const std::size_t end = index(*state.map.joint_of[marey::index(bone)]);
  std::vector<RigidTransform> joints(skeleton.joints.size());
  BodyReach out;
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const Pose reference = state.motion.poses[t];
    world_from_joints(skeleton, reference, joints);
    for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
      auto stands = adapter->constraint(name(foot));
      if (!stands) continue;
      const JointIndex joint = *state.map.joint_of[marey::index(foot)];
      stands->set_target(joints[index(joint)].translation);
      stands->set_orientation(
          glm::normalize(retarget::rotation_from_t_pose(state.map, joints, joint)));
    }
    adapter->constraint(kReachId)->set_target(path_in_world[t]);
    adapter->adapt(reference, frame / state.motion.rate.hz, state.motion.poses[t]);
    world_from_joints(skeleton, state.motion.poses[t], joints);
    const double missed_m = glm::distance(joints[end].translation, path_in_world[t]);
    if (missed_m <= out.missed_m) continue;
    out.missed_m = missed_m;
    out.missed_frame = frame;
  }
  return out;
}

}  // namespace marey::edit
