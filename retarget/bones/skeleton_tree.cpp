// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/skeleton_tree.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::retarget {

SkeletonTree::SkeletonTree(const Skeleton& skeleton) : skeleton_(&skeleton) {
  const std::size_t count = skeleton.joints.size();
  children_.resize(count);
  depth_.assign(count, 0);
  reach_.assign(count, 0.0);
  world_from_joint_ = world_from_joints(skeleton, rest_pose(skeleton));
  for (std::size_t i = 0; i < count; ++i) {
    const auto above = skeleton.joints[i].parent;
    if (!above) continue;
    children_[index(*above)].push_back(JointIndex{static_cast<int>(i)});
    depth_[i] = depth_[index(*above)] + 1;
  }
  // Parents come first, so the children of joint i have indices above i.
  for (std::size_t i = count; i-- > 0;) {
    const Joint& joint = skeleton.joints[i];
    if (joint.tip_in_joint) {
      reach_[i] = std::max(reach_[i], glm::length(*joint.tip_in_joint));
    }
    if (!joint.parent) continue;
    double& above = reach_[index(*joint.parent)];
    above = std::max(above, reach_[i] + glm::length(joint.parent_from_joint.translation));
  }
}

std::optional<glm::dvec3> SkeletonTree::tip(JointIndex joint) const {
  const auto& tip = (*skeleton_)[joint].tip_in_joint;
  if (!tip) return std::nullopt;
  return world_from_joint_[index(joint)] * *tip;
}

double SkeletonTree::distance(JointIndex a, JointIndex b) const {
  return glm::distance(place(a), place(b));
}

bool SkeletonTree::is_below(JointIndex below, JointIndex above) const {
  while (depth_[index(below)] > depth_[index(above)]) {
    below = *parent(below);
    if (below == above) return true;
  }
  return false;
}

JointIndex SkeletonTree::common(std::span<const JointIndex> joints) const {
  JointIndex deepest = joints[0];
  for (JointIndex other : joints) {
    while (deepest != other) {
      JointIndex& lower =
          depth_[index(deepest)] >= depth_[index(other)] ? deepest : other;
      lower = *parent(lower);
    }
  }
  return deepest;
}

std::vector<JointIndex> SkeletonTree::between(JointIndex above, JointIndex below) const {
  std::vector<JointIndex> way;
  for (auto joint = parent(below); joint && *joint != above; joint = parent(*joint)) {
    way.push_back(*joint);
  }
  std::reverse(way.begin(), way.end());
  return way;
}

std::vector<JointIndex> SkeletonTree::longest_path(JointIndex joint) const {
  std::vector<JointIndex> way{joint};
  for (;;) {
    std::optional<JointIndex> next;
    double longest = -1.0;
    for (const JointIndex child : children(way.back())) {
      const double length = distance(way.back(), child) + reach(child);
      if (length <= longest) continue;
      longest = length;
      next = child;
    }
    if (!next) return way;
    way.push_back(*next);
  }
}

std::string SkeletonTree::quoted(JointIndex joint) const {
  const std::string& name = (*skeleton_)[joint].name;
  if (name.empty()) return "joint " + std::to_string(index(joint));
  std::string text = "'";
  text += name.substr(0, 40);
  text += '\'';
  return text;
}

}  // namespace marey::retarget
