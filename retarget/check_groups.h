// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/ids.h"
#include "core/result.h"
#include "core/transform.h"

namespace marey::retarget {

/// What the parts of check_character() share.
struct CharacterCheck {
  const Character& character;
  std::vector<RigidTransform> world_from_joint;  ///< At rest.
  std::vector<int> group_of;                     ///< Per joint; -1: none.

  [[nodiscard]] Error refuse(const std::string& element,
                             std::string cause,
                             std::string next) const;
  [[nodiscard]] bool has(JointIndex joint) const;
  [[nodiscard]] std::string called(JointIndex joint) const;  ///< `joint "leftHand"`
  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world_from_joint[index(joint)].translation;
  }
};

[[nodiscard]] std::string in_quotes(const std::string& name);

/// The groups, their order and their parts; fills `group_of`.
/// Precondition: the skeleton is sound and at rest in `world_from_joint`; `group_of` is
/// all -1.
[[nodiscard]] Status check_groups(CharacterCheck& check);

/// How far directions and rotations that people write down may be off.
inline constexpr double kRounded = 1e-3;

}  // namespace marey::retarget
