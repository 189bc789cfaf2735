// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/character_spec.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Returns the limits of a body's joints, in joint order, with angles in radians relative
/// to the T-pose. A joint has the limit that `traits` states for it; else, unless
/// `traits.has_limits` is false, the typical human limit of its bone or vertebra. Joints
/// without a limit are not listed. Precondition: `traits` is for the skeleton of `map`.
[[nodiscard]] std::vector<JointLimit> joint_limits(const BodyMap& map,
                                                   const CharacterTraits& traits);

}  // namespace marey::retarget
