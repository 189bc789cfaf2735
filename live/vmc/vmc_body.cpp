// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_body.h"

#include <algorithm>
#include <string>

#include "core/base/assert.h"

namespace marey::live {
namespace {

constexpr glm::dquat kNoTurn{1.0, 0.0, 0.0, 0.0};
constexpr glm::dquat kHalfTurn{0.0, 0.0, 1.0, 0.0};  // About Y.

std::vector<glm::dquat> rotations_of(std::span<const RigidTransform> frames) {
  std::vector<glm::dquat> rotations;
  rotations.reserve(frames.size());
  for (const RigidTransform& frame : frames) rotations.push_back(frame.rotation);
  return rotations;
}

}  // namespace

Result<VmcBody> VmcBody::make(const Skeleton& skeleton, const VmcBodyOptions& options) {
  MAREY_ASSERT(!skeleton.joints.empty() && !skeleton.joints[0].parent);
  MAREY_ASSERT(options.t_pose_from_joint.empty() ||
               options.t_pose_from_joint.size() == skeleton.joints.size());
  for (const HumanBone bone : human_bones()) {
    if (is_required(bone) && !skeleton.find(bone)) {
      return bad_input("",
                       "no joint is the " + std::string(marey::name(bone)) +
                           ", without which VMC has no humanoid",
                       "name the body's bones in a bone map");
    }
  }
  VmcBody body;
  body.skeleton_ = skeleton;
  body.rest_ = options.rest;
  if (options.file_faces_back) body.world_from_file_ = kHalfTurn;
  const Pose rest = rest_pose(skeleton);
  if (options.rest == VmcRest::kVrm0 && !options.t_pose_from_joint.empty()) {
    body.world_from_joint_at_zero_.assign(options.t_pose_from_joint.begin(),
                                          options.t_pose_from_joint.end());
  } else {
    body.world_from_joint_at_zero_ = rotations_of(world_from_joints(skeleton, rest));
  }
  body.find_bones();
  for (const Bone& bone : body.list_) {
    if (bone.above.has_value() == (bone.unity != UnityBone::kHips)) continue;
    return bad_input("",
                     "the hips do not carry the " + std::string(name(bone.unity)),
                     "correct the body's bones in a bone map");
  }
  body.find_frames(options.file_from_root_parent);
  body.find_missing();
  return body;
}

void VmcBody::find_bones() {
  for (std::size_t i = 0; i < skeleton_.joints.size(); ++i) {
    const Joint& joint = skeleton_.joints[i];
    // If two joints have the same bone, the skeleton uses the first.
    if (!joint.bone || skeleton_.find(*joint.bone) != JointIndex{static_cast<int>(i)}) {
      continue;
    }
    Bone bone;
    bone.joint = JointIndex{static_cast<int>(i)};
    bone.unity = unity_bone(*joint.bone);
    for (auto at = joint.parent; at && !bone.above; at = skeleton_[*at].parent) {
      if (skeleton_[*at].bone) bone.above = *at;
    }
    list_.push_back(bone);
    bones_.push_back(bone.unity);
  }
}

void VmcBody::find_frames(const RigidTransform& file_from_root_parent) {
  const RigidTransform world_from_file{world_from_file_, {}};
  const Pose zero = pose_from_world(skeleton_,
                                    skeleton_.joints[0].parent_from_joint.translation,
                                    world_from_joint_at_zero_);
  const auto placed = world_from_joints(skeleton_, zero);
  for (Bone& bone : list_) {
    const auto parent = skeleton_[bone.joint].parent;
    const RigidTransform a = bone.above ? placed[index(*bone.above)] : RigidTransform{};
    const RigidTransform p =
        parent ? placed[index(*parent)] : world_from_file * file_from_root_parent;
    if (rest_ == VmcRest::kRaw) {
      const RigidTransform p_from_a = inverse(p) * a;
      bone.before = world_from_file_ * p_from_a.rotation;
      bone.after = glm::conjugate(world_from_file_);
      bone.moved = world_from_file_ * p_from_a.translation;
    } else {
      bone.before = a.rotation;
      bone.after = glm::conjugate(placed[index(bone.joint)].rotation);
      bone.moved = a.translation - p.translation;
    }
  }
  hips_at_zero_in_world_ = placed[index(*skeleton_.find(HumanBone::kHips))].translation;
}

void VmcBody::find_missing() {
  for (Bone& bone : list_) {
    std::vector<UnityBone> missing;
    auto at = parent(*skeleton_[bone.joint].bone);
    for (; at && !skeleton_.find(*at); at = parent(*at)) {
      missing.push_back(unity_bone(*at));
    }
    const bool usual = at && bone.above && skeleton_.find(*at) == bone.above;
    if (!usual || missing.size() > bone.missing.size()) continue;
    std::copy(missing.rbegin(), missing.rend(), bone.missing.begin());
  }
}

RigidTransform VmcBody::above_from_bone(const Pose& pose, const Bone& bone) const {
  RigidTransform above_from_bone{pose.parent_from_joint[index(bone.joint)],
                                 skeleton_[bone.joint].parent_from_joint.translation};
  if (!skeleton_[bone.joint].parent) {
    above_from_bone.translation = pose.root_in_world;
    return above_from_bone;
  }
  for (auto at = skeleton_[bone.joint].parent; at && at != bone.above;
       at = skeleton_[*at].parent) {
    const RigidTransform step{pose.parent_from_joint[index(*at)],
                              skeleton_[*at].parent
                                  ? skeleton_[*at].parent_from_joint.translation
                                  : pose.root_in_world};
    above_from_bone = step * above_from_bone;
  }
  return above_from_bone;
}

void VmcBody::to_vmc(const Pose& pose, VmcPose& out) const {
  MAREY_ASSERT(pose.parent_from_joint.size() == skeleton_.joints.size());
  out.has.reset();
  out.root = {};
  for (const Bone& bone : list_) {
    const RigidTransform folded = above_from_bone(pose, bone);
    const glm::dquat turn = glm::normalize(bone.before * folded.rotation * bone.after);
    out.set(
        bone.unity,
        {mirrored_x(bone.before * folded.translation + bone.moved), mirrored_x(turn)});
  }
}

glm::dquat VmcBody::turn_of(const VmcPose& received, const Bone& bone) const {
  glm::dquat turn = kNoTurn;
  for (const auto& missing : bone.missing) {
    if (missing && received.contains(*missing)) {
      turn = turn * mirrored_x(received.local[index(*missing)].rotation);
    }
  }
  return received.contains(bone.unity)
             ? turn * mirrored_x(received.local[index(bone.unity)].rotation)
             : turn;
}

void VmcBody::turn_joints(const VmcPose& received, Pose& out) const {
  for (std::size_t i = 0; i < skeleton_.joints.size(); ++i) {
    const auto above = skeleton_.joints[i].parent;
    const glm::dquat& at_zero = world_from_joint_at_zero_[i];
    out.parent_from_joint[i] =
        above ? glm::conjugate(world_from_joint_at_zero_[index(*above)]) * at_zero
              : at_zero;
  }
  for (const Bone& bone : list_) {
    const std::size_t joint = index(bone.joint);
    const auto above = skeleton_[bone.joint].parent;
    glm::dquat& local = out.parent_from_joint[joint];
    if (rest_ == VmcRest::kRaw) {
      if (!received.contains(bone.unity)) continue;
      const glm::dquat& before = above ? world_from_file_ : bone.before;
      local = glm::conjugate(before) *
              mirrored_x(received.local[index(bone.unity)].rotation) * world_from_file_;
    } else {
      const glm::dquat turned =
          turn_of(received, bone) * world_from_joint_at_zero_[joint];
      local = above ? glm::conjugate(world_from_joint_at_zero_[index(*above)]) * turned
                    : turned;
    }
  }
  for (glm::dquat& rotation : out.parent_from_joint) rotation = glm::normalize(rotation);
  out.parent_from_joint[0] =
      mirrored_x(received.root.rotation) * out.parent_from_joint[0];
}

void VmcBody::place_root(const VmcPose& received, Pose& out) const {
  const Bone& hips = list_.front();
  glm::dvec3 hips_in_root = hips_at_zero_in_world_;
  if (received.contains(hips.unity)) {
    const glm::dvec3 p = mirrored_x(received.local[index(hips.unity)].position);
    hips_in_root = glm::conjugate(hips.before) * (p - hips.moved);
  }
  const glm::dvec3 hips_in_world = mirrored_x(received.root.rotation) * hips_in_root +
                                   mirrored_x(received.root.position);
  out.root_in_world = glm::dvec3(0.0);
  out.root_in_world = hips_in_world - above_from_bone(out, hips).translation;
}

void VmcBody::from_vmc(const VmcPose& received, Pose& out) const {
  out.parent_from_joint.resize(skeleton_.joints.size());
  turn_joints(received, out);
  place_root(received, out);
}

}  // namespace marey::live
