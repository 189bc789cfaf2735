// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/humanoid.h"

namespace marey {

/// The user's setting for one bone. If it is not set, the bone is identified
/// automatically.
struct BoneOverride {
  bool is_set = false;
  /// If set: nullopt means that the body has no such bone.
  std::optional<JointIndex> joint;
};

/// The user's settings for a body from another program. All other properties are
/// identified automatically.
struct BoneMap {
  std::array<BoneOverride, kHumanBoneCount> bones{};
  std::optional<double> unit_m;  ///< Length of the file's unit. [m]
  /// Up axis of the body at rest, in the file's axes; unit.
  std::optional<glm::dvec3> up;
  /// Direction that it faces at rest, in the file's axes; unit.
  std::optional<glm::dvec3> front;
};

}  // namespace marey
