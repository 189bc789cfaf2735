// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/character.h"
#include "core/result.h"

namespace marey::retarget {

/// Whether adaptation can work with a character, however it was made. Linear in joints
/// and parts.
///
/// Errors (bad input), naming the joint, group or load:
/// - the skeleton: no joints, a parent after its child, more than one root, a number that
///   is not finite, a rotation that is not unit; a T-pose of another number of joints;
/// - groups: none, without a name or with another's, without parts, one joint in two of
///   them; parents in a circle; not exactly one group of level 1, or not the last; a
///   parent that is not one level above;
/// - parts: a segment that is not one joint, a section whose joints do not hang on one
///   another from low to high, a limb whose three do not, or that has a bone without
///   length. Other joints may lie between (twist bones): they rest in their parent and
///   are in no group. A limb's end may be a segment of its own, too;
/// - a hinge that is not unit or not across its limb's upper bone, by 1e-3;
/// - limits: two of one joint, min above max, beyond half a turn;
/// - flexibility: an angle that is not from 0 to pi;
/// - masses: a negative one, a total that is not above zero; loads: without a name or
///   with another's, a negative mass.
///
/// Vertebrae may coincide: captured skeletons have such.
[[nodiscard]] Status check_character(const Character& character);

/// Whether it can stand: an error when no group that can_support has a limb. For those
/// who ask for supports. Precondition: check_character() found nothing.
[[nodiscard]] Status check_supports(const Character& character);

}  // namespace marey::retarget
