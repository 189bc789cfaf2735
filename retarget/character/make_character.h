// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/character.h"
#include "core/character_spec.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Makes the character of a human for adaptation (Kulpa 2005, 4.1, figures 4.3 and 4.4).
///
/// Groups, in the order of adaptation: head, right arm, left arm, right leg, left leg,
/// trunk, root. Parts are ordered from the end of a group to its root, in the trunk
/// abdomen before torso. Bodies without neck, clavicles or toes have fewer parts. Without
/// one of a limb's three bones the others become segments. A group without parts is
/// omitted, and its children are attached to the next lower group. Hinges are those of
/// BodyMap. Joints between a limb's marked ones are in no group.
///
/// Errors (bad input): those of place_masses() and check_character(); a load without a
/// name, with a duplicate name, on an unknown segment, or with a mass or position that is
/// not finite. Precondition: `map` was made from `skeleton`.
[[nodiscard]] Result<Character> make_character(std::string name,
                                               Skeleton skeleton,
                                               const BodyMap& map,
                                               const CharacterTraits& traits = {});

}  // namespace marey::retarget
