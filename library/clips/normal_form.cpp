// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/clips/normal_form.h"

#include <cstddef>
#include <span>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/skeleton.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::library {
namespace {

/// Returns the world rotation of every joint in the canonical T-pose.
std::vector<glm::dquat> world_from_t_pose(const Skeleton& skeleton,
                                          const retarget::BodyMap& map) {
  std::vector<glm::dquat> out;
  out.reserve(skeleton.joints.size());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const glm::dquat& rest = joint.parent_from_joint.rotation;
    if (map.joints[j].role != retarget::JointRole::kFree) {
      out.push_back(map.joints[j].t_pose_from_joint);
    } else {
      out.push_back(joint.parent ? out[index(*joint.parent)] * rest : rest);
    }
  }
  return out;
}

void mark_contacts(const std::vector<FrameRange>& ranges,
                   std::size_t part,
                   std::vector<FootParts>& out) {
  for (const FrameRange& range : ranges) {
    for (int f = range.first; f <= range.last; ++f) {
      out[static_cast<std::size_t>(f)][part] = 1;
    }
  }
}

}  // namespace

Motion in_normal_form(const Motion& motion, const retarget::BodyMap& map) {
  const Skeleton& old = motion.skeleton;
  const std::vector<glm::dquat> t_pose = world_from_t_pose(old, map);
  Motion out;
  out.rate = motion.rate;
  out.first_frame = motion.first_frame;
  out.skeleton = old;
  for (std::size_t j = 0; j < old.joints.size(); ++j) {
    Joint& joint = out.skeleton.joints[j];
    joint.parent_from_joint.rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
    if (joint.parent) {
      joint.parent_from_joint.translation =
          t_pose[index(*joint.parent)] * old.joints[j].parent_from_joint.translation;
    }
    if (joint.tip_in_joint) joint.tip_in_joint = t_pose[j] * *joint.tip_in_joint;
  }
  out.poses.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    Pose turned;
    turned.root_in_world = pose.root_in_world;
    turned.parent_from_joint.reserve(old.joints.size());
    for (std::size_t j = 0; j < old.joints.size(); ++j) {
      // From the parent's new axes to its old ones, to the joint's old ones, to its new.
      const glm::dquat local = pose.parent_from_joint[j] * glm::conjugate(t_pose[j]);
      const auto& parent = old.joints[j].parent;
      turned.parent_from_joint.push_back(
          glm::normalize(parent ? t_pose[index(*parent)] * local : local));
    }
    out.poses.push_back(std::move(turned));
  }
  return out;
}

Result<LibraryMotion> make_library_motion(
    const Motion& motion, std::vector<std::vector<JointUncertainty>> uncertainty) {
  if (motion.poses.empty()) {
    return bad_input("", "the motion has no frames", "leave the file out with skip");
  }
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  LibraryMotion out;
  out.motion = in_normal_form(motion, *map);
  out.uncertainty = std::move(uncertainty);
  out.contacts.resize(motion.poses.size());
  const Contacts contacts = retarget::detect_contacts(motion, *map);
  for (std::size_t side = 0; side < contacts.feet.size(); ++side) {
    mark_contacts(contacts.feet[side].heel, 2 * side, out.contacts);
    mark_contacts(contacts.feet[side].ball, 2 * side + 1, out.contacts);
  }
  return out;
}

LibraryMotion part_of(const LibraryMotion& motion, int first, int last) {
  const auto frames = static_cast<int>(motion.motion.poses.size());
  MAREY_ASSERT(0 <= first && first <= last && last < frames);
  const auto part = [&](const auto& all) {
    return std::decay_t<decltype(all)>(all.begin() + first, all.begin() + last + 1);
  };
  LibraryMotion out;
  out.motion.skeleton = motion.motion.skeleton;
  out.motion.rate = motion.motion.rate;
  out.motion.first_frame = motion.motion.first_frame + first;
  out.motion.poses = part(motion.motion.poses);
  out.contacts = part(motion.contacts);
  if (!motion.uncertainty.empty()) out.uncertainty = part(motion.uncertainty);
  return out;
}

}  // namespace marey::library
