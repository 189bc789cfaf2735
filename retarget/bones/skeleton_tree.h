// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::retarget {

/// Queries on the tree of a skeleton, with precomputed positions and lengths. Refers to
/// the skeleton, which has one root, its first joint.
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
  /// Position at rest, in the file's world and unit.
  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world_from_joint_[index(joint)].translation;
  }
  /// End of a bone without children, if the file states it.
  [[nodiscard]] std::optional<glm::dvec3> tip(JointIndex joint) const;
  [[nodiscard]] double distance(JointIndex a, JointIndex b) const;
  /// Returns true if `below` is a descendant of `above`. A joint is not its own
  /// descendant.
  [[nodiscard]] bool is_below(JointIndex below, JointIndex above) const;
  /// Returns the deepest joint that is each of `joints` or above it.
  /// Precondition: not empty.
  [[nodiscard]] JointIndex common(std::span<const JointIndex> joints) const;
  /// Returns the joints between the two, high to low, both excluded.
  /// Precondition: is_below(below, above).
  [[nodiscard]] std::vector<JointIndex> between(JointIndex above, JointIndex below) const;
  /// Length of the longest path down from the joint, tips included, in the file's unit.
  [[nodiscard]] double reach(JointIndex joint) const { return reach_[index(joint)]; }
  /// Joints of that path, the joint itself first.
  [[nodiscard]] std::vector<JointIndex> longest_path(JointIndex joint) const;
  /// Returns 'Hips' in quotes, or: joint 12, if it has no name.
  [[nodiscard]] std::string quoted(JointIndex joint) const;

 private:
  const Skeleton* skeleton_;
  std::vector<std::vector<JointIndex>> children_;
  std::vector<RigidTransform> world_from_joint_;
  std::vector<double> reach_;
  std::vector<int> depth_;
};

}  // namespace marey::retarget
