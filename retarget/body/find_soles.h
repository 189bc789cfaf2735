// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Ends of one sole, as in FootMap.
struct SoleEnds {
  glm::dvec3 heel_from_ankle_in_t_pose{0.0};
  glm::dvec3 tip_from_ball_in_t_pose{0.0};
  /// The toe joint carries skin: the front of the foot bends there.
  bool toes_bend = true;
};
using Soles = std::array<std::optional<SoleEnds>, 2>;  ///< Left, right.

/// Finds the soles of a body's skin. Considers the vertices that a foot and its
/// descendants carry, up to a tenth of the leg above the floor (a shoe's sole is round in
/// front and behind). The ends are the rearmost and the foremost of them. nullopt without
/// skin.
///
/// `p_in_world` are the skin's vertices at rest, `carrier` the joint with the largest
/// weight of each.
/// Precondition: both have the same length; `map` was made from `skeleton`. Linear in
/// vertices.
[[nodiscard]] Soles find_soles(const Skeleton& skeleton,
                               const BodyMap& map,
                               std::span<const glm::dvec3> p_in_world,
                               std::span<const JointIndex> carrier);

/// Replaces the estimated soles of the map by these, where they are known.
void apply_soles(const Soles& soles, BodyMap& map);

}  // namespace marey::retarget
