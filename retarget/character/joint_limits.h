// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/character_spec.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Returns the limits of a body's joints: of its bones and of its vertebrae, marked or
/// not. Limits in `traits` replace these, also if `traits` excludes all others.
[[nodiscard]] std::vector<JointLimit> joint_limits(const BodyMap& map,
                                                   const CharacterTraits& traits);

}  // namespace marey::retarget
