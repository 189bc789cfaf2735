// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "live/vmc/unity_bone.h"

namespace marey::live {

/// A node's transform in its parent's frame in Unity's axes: left-handed, Y up, a body
/// faces +Z with its left hand towards -X. This is marey's world mirrored, X -> -X.
struct UnityTransform {
  glm::dvec3 position{0.0};                 ///< [m]
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< Unit.
};

/// Converts a point or direction from marey's axes to Unity's and back; a mirror is its
/// own inverse.
[[nodiscard]] inline glm::dvec3 mirrored_x(const glm::dvec3& p) {
  return {-p.x, p.y, p.z};
}
/// Converts a rotation: M R M with M = diag(-1, 1, 1).
[[nodiscard]] inline glm::dquat mirrored_x(const glm::dquat& q) {
  return {q.w, q.x, -q.y, -q.z};
}

/// One frame of a body in VMC's terms: the local position and rotation that a receiver
/// sets on the avatar's nodes. `local` is meaningless for bones that are not in `has`.
struct VmcPose {
  UnityTransform root;
  std::array<UnityTransform, kUnityBoneCount> local{};
  std::bitset<kUnityBoneCount> has;

  [[nodiscard]] bool contains(UnityBone bone) const { return has[index(bone)]; }
  void set(UnityBone bone, const UnityTransform& transform) {
    local[index(bone)] = transform;
    has.set(index(bone));
  }
};

}  // namespace marey::live
