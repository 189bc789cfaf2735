// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"

namespace marey::retarget {

/// A vertex of a skin: its place when the skeleton is in its rest pose, and the joint
/// that carries most of it.
struct SkinPoint {
  glm::dvec3 p_in_world{0.0};  ///< [m]
  JointIndex joint{};
};

/// Computes the volume of a body from its skin. Limbs keep the axes of average_volume()
/// and get the median distance of the skin from them. Hands get half their thinner extent
/// and end at the finger tips; their outermost points are kept. Each slice of the trunk
/// gets the breadth and depth that contain its vertices except the outermost thirtieth. A
/// part of fewer than 12 vertices keeps the average's size. Linear in vertices.
/// Precondition: `map` was made from `skeleton`; joints are of the skeleton.
[[nodiscard]] BodyVolume volume_of_skin(const Skeleton& skeleton,
                                        const BodyMap& map,
                                        std::span<const SkinPoint> skin);

}  // namespace marey::retarget
