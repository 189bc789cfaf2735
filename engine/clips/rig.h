// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/engine/blend_posture.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// Lengths of a body by which places of its hands and feet follow from a BlendPosture
/// without expanding it. All in lengths of its leg, along the axes of the T-pose.
struct Rig {
  double leg_length_m = 1.0;
  std::array<glm::dvec3, 2> hip_from_hips_legs{};  ///< Upper leg's joint; left, right.
  std::array<double, 2> leg_legs{};                ///< Sum of thigh and shank.
  std::array<glm::dvec3, 2> ball_from_ankle_legs{};
  std::array<double, 2> ankle_height_legs{};
  std::array<double, 2> ball_height_legs{};
  glm::dvec3 neck_from_hips_legs{};                     ///< Base of the neck.
  std::array<glm::dvec3, 2> shoulder_from_neck_legs{};  ///< Upper arm's joint.
  std::array<double, 2> arm_legs{};
  glm::dvec3 head_from_neck_legs{};
};

/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] Rig make_rig(const Skeleton& skeleton, const retarget::BodyMap& map);

/// Places of the feet relative to the hips joint, in the heading frame. [legs]
struct FootPlaces {
  std::array<glm::dvec3, 2> ankle{};  ///< Left, right.
  std::array<glm::dvec3, 2> ball{};
};
[[nodiscard]] FootPlaces foot_places(const Rig& rig, const BlendPosture& posture);

/// Places of hands (wrists) and head, to some centimetres: the spine is straight from
/// hips to neck with the rotation of the torso's middle.
struct UpperPlaces {
  std::array<glm::dvec3, 2> wrist{};
  glm::dvec3 head{};
};
[[nodiscard]] UpperPlaces upper_places(const Rig& rig, const BlendPosture& posture);

}  // namespace marey::engine
