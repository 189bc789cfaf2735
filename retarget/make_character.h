// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/character.h"
#include "core/character_spec.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// A human as adaptation sees it (Kulpa 2005, 4.1, figures 4.3 and 4.4).
///
/// Groups, in the order of adaptation: head, right arm, left arm, right leg, left leg,
/// trunk, root; parts from the end of a group to its root, in the trunk abdomen before
/// torso. Who lacks a neck, clavicles or toes has fewer parts; who lacks one of a limb's
/// three bones has the others as segments; a group without parts is left out, and what
/// it carried hangs on the next one below. Hinges are BodyMap's. Joints between a limb's
/// marked ones are in no group.
///
/// Errors (bad input): place_masses()'s; a load without a name or with another's, on a
/// segment that the skeleton does not have, or whose mass or place is not a number; what
/// check_character() refuses.
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] Result<Character> make_character(std::string name,
                                               Skeleton skeleton,
                                               const BodyMap& map,
                                               const CharacterTraits& traits = {});

}  // namespace marey::retarget
