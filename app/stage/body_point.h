// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/constraint.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// A point of a character whose joint is known.
struct PointOfBody {
  JointIndex joint{};
  glm::dvec3 offset_in_joint{0.0};

  [[nodiscard]] glm::dvec3 in_world(
      std::span<const RigidTransform> world_from_joint) const {
    return world_from_joint[index(joint)] * offset_in_joint;
  }
};

/// Returns a point by its segment: a bone by VRM's name, else a joint by its own;
/// nullopt: the body has no such segment.
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] std::optional<PointOfBody> point_of_body(const Skeleton& skeleton,
                                                       const retarget::BodyMap& map,
                                                       const BodyPoint& point);

}  // namespace marey::app
