// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Joint positions that determine the orientation of a body.
struct BodyPlaces {
  std::array<glm::dvec3, 2> hip{};
  std::array<glm::dvec3, 2> foot{};
  glm::dvec3 hips{0.0};
  std::optional<glm::dvec3> head;

  [[nodiscard]] glm::dvec3 mid_hip() const { return 0.5 * (hip[0] + hip[1]); }
  [[nodiscard]] glm::dvec3 mid_foot() const { return 0.5 * (foot[0] + foot[1]); }
};

template <class Place>
BodyPlaces body_places(const FoundBones& found, const Place& place) {
  using B = HumanBone;
  BodyPlaces p;
  p.hip = {place(*found.joint(B::kLeftUpperLeg)), place(*found.joint(B::kRightUpperLeg))};
  p.foot = {place(*found.joint(B::kLeftFoot)), place(*found.joint(B::kRightFoot))};
  p.hips = place(*found.joint(B::kHips));
  for (const B bone : {B::kHead, B::kNeck, B::kUpperChest, B::kChest, B::kSpine}) {
    const auto joint = found.joint(bone);
    if (joint && !p.head) p.head = place(*joint);
  }
  return p;
}

/// Returns `v` scaled to length 1, or zero.
inline glm::dvec3 unit_of(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// Returns the axis whose cosine to `direction` is at least `cosine`, or the direction
/// itself.
inline glm::dvec3 snapped(const glm::dvec3& direction, double cosine) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < cosine) continue;
    glm::dvec3 exact(0.0);
    exact[axis] = direction[axis] > 0.0 ? 1.0 : -1.0;
    return exact;
  }
  return direction;
}

}  // namespace marey::retarget
