// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/ids.h"

namespace marey {

/// What a user says of one bone. Not told: it is to be found.
struct ToldBone {
  bool told = false;
  std::optional<JointIndex> joint;  ///< When told: nullopt if the body has no such bone.
};

/// What a user says of a body from elsewhere, of which marey finds the rest by itself.
struct BoneMap {
  std::array<ToldBone, kHumanBoneCount> bones{};
  std::optional<double> unit_m;     ///< Length of the file's unit. [m]
  std::optional<glm::dvec3> up;     ///< Of the body at rest, in the file's axes; unit.
  std::optional<glm::dvec3> front;  ///< Where it looks, likewise.
};

}  // namespace marey
