// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/reparent_bones.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

/// Returns the joint that must carry a bone.
std::optional<JointIndex> required_carrier(const FoundBones& found, B bone) {
  const bool leaves_spine = bone == B::kNeck || bone == B::kHead ||
                            bone == B::kLeftShoulder || bone == B::kRightShoulder ||
                            bone == B::kLeftUpperArm || bone == B::kRightUpperArm;
  for (auto next = parent(bone); next; next = parent(*next)) {
    if (const auto joint = found.joint(*next)) return joint;
    if (!leaves_spine && *next == B::kHips) break;
  }
  return std::nullopt;
}

class Hanger {
 public:
  Hanger(const Skeleton& skeleton,
         const FoundBones& found,
         const std::vector<bool>& carries_skin)
      : tree_(skeleton), found_(found), carries_skin_(carries_skin) {
    for (const Joint& joint : skeleton.joints) parent_.push_back(joint.parent);
  }

  bool find_parents() {
    bool is_new = false;
    for (const B bone : human_bones()) {
      const auto joint = found_.joint(bone);
      const auto upper = joint ? carrier_of(found_, bone) : std::nullopt;
      if (!upper || tree_.is_below(*joint, *found_.joint(*upper))) continue;
      const auto carrier = required_carrier(found_, bone);
      if (!carrier) continue;
      parent_[index(*joint)] = carrier;
      is_new = true;
    }
    return hang_strays() || is_new;
  }

  /// Returns the joints, parents first, and their joints in the file; nullopt if bones
  /// carry each other.
  [[nodiscard]] std::optional<ReparentedBody> make() const {
    ReparentedBody body;
    body.found = found_;
    const std::size_t count = parent_.size();
    std::vector<std::optional<JointIndex>> new_joint(count);
    std::vector<std::vector<JointIndex>> children(count);
    for (std::size_t i = 1; i < count; ++i) {
      if (parent_[i]) {
        children[index(*parent_[i])].push_back(JointIndex{static_cast<int>(i)});
      }
    }
    const auto world = world_from_joints(tree_.skeleton(), rest_pose(tree_.skeleton()));
    std::vector<JointIndex> open{JointIndex{0}};
    while (!open.empty()) {
      const JointIndex old = open.back();
      open.pop_back();
      new_joint[index(old)] = JointIndex{static_cast<int>(body.skeleton.joints.size())};
      Joint joint = tree_.skeleton()[old];
      if (const auto above = parent_[index(old)]) {
        joint.parent = new_joint[index(*above)];
        if (above != tree_.parent(old)) {
          joint.parent_from_joint = inverse(world[index(*above)]) * world[index(old)];
        }
      }
      body.skeleton.joints.push_back(std::move(joint));
      body.read_joint.emplace_back(old);
      const auto& below = children[index(old)];
      open.insert(open.end(), below.rbegin(), below.rend());
    }
    if (body.skeleton.joints.size() != count) return std::nullopt;
    for (auto& bone : body.found.bones) {
      if (bone) bone->joint = *new_joint[index(bone->joint)];
    }
    return body;
  }

 private:
  /// True for joints that carry skin, and for their ancestors.
  [[nodiscard]] std::vector<bool> skinned_branches() const {
    std::vector<bool> branches = carries_skin_;
    // Parents come first.
    for (std::size_t i = branches.size(); i-- > 1;) {
      const auto above = tree_.skeleton().joints[i].parent;
      if (branches[i] && above) branches[index(*above)] = true;
    }
    return branches;
  }

  /// Distance from a place to the bone that begins at a joint.
  [[nodiscard]] double distance_to_bone(const glm::dvec3& place, B bone) const {
    const JointIndex joint = *found_.joint(bone);
    const glm::dvec3 from = tree_.place(joint);
    double nearest = glm::distance(place, from);
    for (const B other : human_bones()) {
      const auto end = found_.joint(other);
      if (!end || required_carrier(found_, other) != joint) continue;
      const glm::dvec3 along = tree_.place(*end) - from;
      const double length2 = glm::dot(along, along);
      if (length2 <= 0.0) continue;
      const double share = std::clamp(glm::dot(place - from, along) / length2, 0.0, 1.0);
      nearest = std::min(nearest, glm::distance(place, from + share * along));
    }
    // A head is as broad as it is long, and its bone has no end joint.
    return bone == B::kHead ? 0.5 * nearest : nearest;
  }

  [[nodiscard]] JointIndex nearest_bone(JointIndex stray) const {
    JointIndex nearest = *found_.joint(B::kHips);
    double min_distance = std::numeric_limits<double>::infinity();
    for (const B bone : human_bones()) {
      const auto joint = found_.joint(bone);
      if (!joint) continue;
      double distance = distance_to_bone(tree_.place(stray), bone);
      // A copy of the bone, of another armature.
      const bool is_copy =
          tree_.skeleton()[*joint].name == tree_.skeleton()[stray].name &&
          tree_.distance(*joint, stray) < 1e-3 * tree_.reach(JointIndex{0});
      if (is_copy) distance = -1.0;
      if (distance >= min_distance) continue;
      min_distance = distance;
      nearest = *joint;
    }
    return nearest;
  }

  bool hang_strays() {
    const auto hips = found_.joint(B::kHips);
    if (carries_skin_.empty() || !hips) return false;
    std::vector<bool> above_hips(parent_.size(), false);
    for (auto at = parent_[index(*hips)]; at && !above_hips[index(*at)];
         at = parent_[index(*at)]) {
      above_hips[index(*at)] = true;
    }
    const std::vector<bool> has_skin = skinned_branches();
    bool is_new = false;
    for (std::size_t i = 1; i < parent_.size(); ++i) {
      const JointIndex joint{static_cast<int>(i)};
      const auto above = parent_[i];
      // The first joint of each branch off the path to the hips.
      if (!above || joint == *hips || above_hips[i]) continue;
      if (!above_hips[index(*above)] || !has_skin[i]) continue;
      parent_[i] = nearest_bone(joint);
      is_new = true;
    }
    return is_new;
  }

  SkeletonTree tree_;
  const FoundBones& found_;
  const std::vector<bool>& carries_skin_;
  std::vector<std::optional<JointIndex>> parent_;
};

/// Adds a foot to a leg that has none.
void make_foot(bool is_left, ReparentedBody& body) {
  const auto hip = body.found.joint(is_left ? B::kLeftUpperLeg : B::kRightUpperLeg);
  const auto knee = body.found.joint(is_left ? B::kLeftLowerLeg : B::kRightLowerLeg);
  const B bone = is_left ? B::kLeftFoot : B::kRightFoot;
  if (body.found.joint(bone) || !hip || !knee) return;
  const SkeletonTree tree(body.skeleton);
  const std::vector<JointIndex> way = tree.longest_path(*knee);
  glm::dvec3 end = 2.0 * tree.place(*knee) - tree.place(*hip);
  if (way.size() > 1) {
    end = tree.place(way[1]);
  } else if (const auto tip = tree.tip(*knee)) {
    end = *tip;
  }
  const auto world = world_from_joints(body.skeleton, rest_pose(body.skeleton));
  Joint foot;
  foot.name = body.skeleton[*knee].name + "_foot";
  foot.parent = knee;
  foot.parent_from_joint.translation = inverse(world[index(*knee)]) * end;
  const JointIndex joint{static_cast<int>(body.skeleton.joints.size())};
  body.skeleton.joints.push_back(std::move(foot));
  body.read_joint.emplace_back(std::nullopt);
  body.found.bones[index(bone)] = FoundBone{joint, BoneEvidence::kChain, 0.6};
}

}  // namespace

std::optional<B> carrier_of(const FoundBones& found, B bone) {
  auto next = parent(bone);
  const bool leaves_spine =
      next == B::kUpperChest && bone != B::kNeck && bone != B::kUpperChest;
  if (leaves_spine) return B::kHips;
  while (next && !found.joint(*next)) {
    const bool left_the_arm = *next == B::kLeftShoulder || *next == B::kRightShoulder;
    next = left_the_arm ? std::optional(B::kHips) : parent(*next);
  }
  return next;
}

Result<std::optional<ReparentedBody>> reparent_to_carriers(
    const Skeleton& skeleton,
    const FoundBones& found,
    const std::vector<bool>& carries_skin) {
  const bool has_feet = found.joint(B::kLeftFoot) && found.joint(B::kRightFoot);
  Hanger hanger(skeleton, found, carries_skin);
  if (!hanger.find_parents() && has_feet) return std::optional<ReparentedBody>{};
  auto made = hanger.make();
  if (!made) {
    return bad_input("skeleton",
                     "its bones cannot be connected: one of them is above the bone that "
                     "must carry it",
                     "correct the bone map");
  }
  ReparentedBody body = *std::move(made);
  for (const bool is_left : {true, false}) make_foot(is_left, body);
  return std::optional<ReparentedBody>{std::move(body)};
}

void convert_to_reparented(const ReparentedBody& body, Motion& motion) {
  const Skeleton read = std::move(motion.skeleton);
  motion.skeleton = body.skeleton;
  std::vector<RigidTransform> world(read.joints.size());
  std::vector<glm::dquat> turned(body.read_joint.size());
  for (Pose& pose : motion.poses) {
    world_from_joints(read, pose, world);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const auto joint = body.read_joint[i];
      turned[i] = joint ? world[index(*joint)].rotation
                        : turned[index(*body.skeleton.joints[i].parent)];
    }
    pose = pose_from_world(body.skeleton, pose.root_in_world, turned);
  }
}

}  // namespace marey::retarget
