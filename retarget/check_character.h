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
///   is not finite, a joint more than 10 km from its parent along an axis, a rotation
///   that is not unit; a T-pose of another number of joints;
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
/// - masses and loads: a negative mass or one above 1e6 kg, a place more than 10 km from
///   its joint along an axis; masses: a total that is not above zero; loads: without a
///   name or with another's.
///
/// Lengths that may be zero: all but those of a limb's two bones, whose directions say
/// how it bends. Captured skeletons have vertebrae in one place, avatars a clavicle in
/// the chest or in the arm, a neck in the head, hips in the pelvis, toes in the foot:
/// such a joint turns all the same, and nobody asks for its bone's direction. Masses that
/// may be zero: any but all together; a segment that weighs nothing moves no centre of
/// mass.
[[nodiscard]] Status check_character(const Character& character);

/// Whether it can stand: an error when no group that can_support has a limb. For those
/// who ask for supports. Precondition: check_character() found nothing.
[[nodiscard]] Status check_supports(const Character& character);

}  // namespace marey::retarget
