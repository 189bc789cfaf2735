// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/ids.h"
#include "core/skeleton.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// Where one sole ends, as in FootMap.
struct SoleEnds {
  glm::dvec3 heel_from_ankle_in_t_pose{0.0};
  glm::dvec3 tip_from_ball_in_t_pose{0.0};
  /// Skin hangs on the toe joint: the front of the foot bends there.
  bool toes_bend = true;
};
using Soles = std::array<std::optional<SoleEnds>, 2>;  ///< Left, right.

/// The soles of a body's skin: of what a foot and all that hangs on it carry, and is no
/// higher above the floor than a tenth of the leg (a shoe's sole is round in front and
/// behind), the last point behind and the first in front. nullopt where no skin is.
///
/// `p_in_world` are the skin's vertices at rest, `carrier` the joint that each follows
/// most. Precondition: as many of both; `map` was made from `skeleton`. Linear in them.
[[nodiscard]] Soles find_soles(const Skeleton& skeleton,
                               const BodyMap& map,
                               std::span<const glm::dvec3> p_in_world,
                               std::span<const JointIndex> carrier);

/// Has the map go by these soles, where they are known, instead of its guesses.
void wear(const Soles& soles, BodyMap& map);

}  // namespace marey::retarget
