// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/clip_on_body.h"

#include <cmath>

#include "app/stage/figures/mean_jerk.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::app {

std::vector<JointIndex> marked_joints(const Skeleton& skeleton) {
  std::vector<JointIndex> joints;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    if (skeleton.joints[i].bone) joints.push_back(JointIndex(static_cast<int>(i)));
  }
  return joints;
}

std::optional<double> clip_jerk_m_s3(ClipOnBody& clip,
                                     const Skeleton& skeleton,
                                     double step_s) {
  const std::vector<JointIndex> joints = marked_joints(skeleton);
  std::vector<glm::dvec3> places(joints.size());
  MeanJerk jerk(step_s);
  const double end_s = clip.clip().duration_s() + 1e-9;
  for (int step = 0; step * step_s <= end_s; ++step) {
    const std::span<const RigidTransform> frames = clip.joints_at(step * step_s);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      places[i] = frames[index(joints[i])].translation;
    }
    jerk.add(places);
  }
  if (jerk.count() == 0) return std::nullopt;
  return jerk.mean_m_s3();
}

double hips_heading_rad(std::span<const RigidTransform> world_from_joint,
                        const retarget::BodyMap& map) {
  const glm::dvec3 forward =
      retarget::rotation_from_t_pose(map, world_from_joint, map.hips()) *
      glm::dvec3(0.0, 0.0, 1.0);
  return std::atan2(forward.x, forward.z);
}

glm::dvec3 neck_in_world(std::span<const RigidTransform> world_from_joint,
                         const retarget::BodyMap& map) {
  for (const HumanBone bone : {HumanBone::kNeck, HumanBone::kHead}) {
    const auto joint = map.joint_of[index(bone)];
    if (joint) return world_from_joint[index(*joint)].translation;
  }
  glm::dvec3 sum(0.0);
  for (const HumanBone bone : {HumanBone::kLeftUpperArm, HumanBone::kRightUpperArm}) {
    sum += world_from_joint[index(*map.joint_of[index(bone)])].translation;
  }
  return 0.5 * sum;
}

std::vector<double> clip_lean_rad(ClipOnBody& clip,
                                  const retarget::BodyMap& map,
                                  double from_s,
                                  double step_s,
                                  std::size_t steps) {
  std::vector<double> lean_rad;
  lean_rad.reserve(steps);
  for (std::size_t step = 0; step < steps; ++step) {
    const auto joints = clip.joints_at(from_s + static_cast<double>(step) * step_s);
    lean_rad.push_back(lateral_lean_rad(joints[index(map.hips())].translation,
                                        neck_in_world(joints, map),
                                        hips_heading_rad(joints, map)));
  }
  return lean_rad;
}

}  // namespace marey::app
