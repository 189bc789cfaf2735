// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::retarget {

/// What telling bones apart asks of a skeleton again and again. Refers to the skeleton,
/// which has one root, its first joint.
class SkeletonTree {
 public:
  explicit SkeletonTree(const Skeleton& skeleton);

  [[nodiscard]] const Skeleton& skeleton() const { return *skeleton_; }
  [[nodiscard]] std::size_t size() const { return children_.size(); }
  [[nodiscard]] const std::vector<JointIndex>& children(JointIndex joint) const {
    return children_[index(joint)];
  }
  [[nodiscard]] std::optional<JointIndex> parent(JointIndex joint) const {
    return (*skeleton_)[joint].parent;
  }
  /// At rest, in the file's world.
  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world_from_joint_[index(joint)].translation;
  }
  /// The end of a bone without children, if the file says where it is.
  [[nodiscard]] std::optional<glm::dvec3> tip(JointIndex joint) const;
  [[nodiscard]] double distance(JointIndex a, JointIndex b) const;
  /// `below` hangs on `above`, directly or not; a joint does not hang on itself.
  [[nodiscard]] bool hangs_on(JointIndex below, JointIndex above) const;
  /// The deepest joint that is each of `joints` or above it. Precondition: not empty.
  [[nodiscard]] JointIndex common(std::span<const JointIndex> joints) const;
  /// The joints between, high to low, without the two. Precondition: hangs_on().
  [[nodiscard]] std::vector<JointIndex> between(JointIndex above, JointIndex below) const;
  /// The longest way down from the joint, tips included, in the file's unit.
  [[nodiscard]] double reach(JointIndex joint) const { return reach_[index(joint)]; }
  /// The joints of that way, the joint itself first.
  [[nodiscard]] std::vector<JointIndex> longest_way(JointIndex joint) const;
  /// 'Hips', or joint 12 when it has no name.
  [[nodiscard]] std::string quoted(JointIndex joint) const;

 private:
  const Skeleton* skeleton_;
  std::vector<std::vector<JointIndex>> children_;
  std::vector<RigidTransform> world_from_joint_;
  std::vector<double> reach_;
  std::vector<int> depth_;
};

}  // namespace marey::retarget
