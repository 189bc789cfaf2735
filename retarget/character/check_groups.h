// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/character.h"
#include "core/transform.h"

namespace marey::retarget {

/// Data shared by the parts of check_character().
struct CharacterCheck {
  const Character& character;
  std::vector<RigidTransform> world_from_joint;  ///< In the rest pose.
  std::vector<int> group_of;                     ///< Per joint; -1: no group.

  [[nodiscard]] Error refuse(const std::string& element,
                             std::string cause,
                             std::string next) const;
  [[nodiscard]] bool has(JointIndex joint) const;
  [[nodiscard]] std::string called(JointIndex joint) const;  ///< `joint "leftHand"`
  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world_from_joint[index(joint)].translation;
  }
};

/// Checks the groups, their order and their parts; fills `group_of`. Precondition: the
/// skeleton is valid and in its rest pose in `world_from_joint`; `group_of` is all -1.
[[nodiscard]] Status check_groups(CharacterCheck& check);

/// Tolerance for directions and rotations in hand-written files.
inline constexpr double kRounded = 1e-3;

}  // namespace marey::retarget
