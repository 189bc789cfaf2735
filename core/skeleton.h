// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/humanoid.h"
#include "core/transform.h"

namespace marey {

struct Joint {
  std::string name;
  std::optional<JointIndex> parent;  ///< nullopt for a root. Parents come first.
  /// Rest pose of this joint in its parent's frame (a root's: in the world).
  RigidTransform parent_from_joint;
  std::optional<HumanBone> bone;  ///< The human bone that this joint is, if any.
  /// End of the last bone of a chain, in this joint's frame: fingertip, top of the head.
  std::optional<glm::dvec3> tip_in_joint;
};

/// Joints, parents before children. marey's own skeletons rest in a T-pose facing +Z with
/// the left hand towards +X and every joint's axes parallel to the world's; a loaded
/// avatar may rest otherwise.
struct Skeleton {
  std::vector<Joint> joints;

  /// Returns the joint that is this bone, if any. Linear in joints.
  [[nodiscard]] std::optional<JointIndex> find(HumanBone bone) const;
  /// Returns the joint of this name, if any. Linear in joints.
  [[nodiscard]] std::optional<JointIndex> find(std::string_view joint_name) const;

  [[nodiscard]] const Joint& operator[](JointIndex joint) const {
    return joints[index(joint)];
  }
};

/// The lengths of a human body, as rest-pose (T-pose, facing +Z) vectors. [m]
struct Proportions {
  /// From each bone's parent joint to its own, axes parallel to the world's. The hips'
  /// entry is the height of the hips above the floor, (0, h, 0).
  std::array<glm::dvec3, kHumanBoneCount> offset_in_parent{};
  glm::dvec3 head_top_in_head{0.0};
  glm::dvec3 left_hand_tip_in_hand{0.0};
  glm::dvec3 right_hand_tip_in_hand{0.0};
  glm::dvec3 left_toe_tip_in_toes{0.0};
  glm::dvec3 right_toe_tip_in_toes{0.0};

  [[nodiscard]] glm::dvec3& operator[](HumanBone bone) {
    return offset_in_parent[index(bone)];
  }
  [[nodiscard]] const glm::dvec3& operator[](HumanBone bone) const {
    return offset_in_parent[index(bone)];
  }
};

/// Returns the T-pose skeleton of these proportions: the 22 bones in the order of
/// human_bones(), so that JointIndex and HumanBone agree, with tips on head, hands and
/// toes.
[[nodiscard]] Skeleton make_humanoid(const Proportions& proportions);

/// Returns the proportions of a skeleton that make_humanoid() could have made.
/// Precondition: it has all 22 bones and identity rest rotations.
[[nodiscard]] Proportions proportions_of(const Skeleton& skeleton);

/// Returns the length of hip to knee to ankle, the mean of both sides. [m]
[[nodiscard]] double leg_length_m(const Proportions& proportions);

}  // namespace marey
