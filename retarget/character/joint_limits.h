// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/character_spec.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Returns the limits of a body's joints: of its bones and of all joints of its spine,
/// also those that are no bone of VRM. A limit in `traits` replaces the default of its
/// joint; with `traits` that exclude the defaults, only theirs remain.
[[nodiscard]] std::vector<JointLimit> joint_limits(const BodyMap& map,
                                                   const CharacterTraits& traits);

}  // namespace marey::retarget
