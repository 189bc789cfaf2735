// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/character.h"

namespace marey::retarget {

/// Checks that a character is valid for adaptation, independent of its source. Linear in
/// joints and parts.
///
/// Errors (bad input), naming the joint, group or load:
/// - skeleton: no joints, a parent after its child, more than one root, a number that is
///   not finite, a joint more than 10 km from its parent along an axis, a rotation that
///   is not unit, a T-pose with another number of joints;
/// - groups: none, a missing or duplicate name, no parts, a joint in two groups, a cycle
///   of parents, not exactly one group of level 1 as the last, a parent that is not one
///   level above;
/// - parts: a segment that is not one joint; a section or limb whose joints are not
///   descendants of each other in order; a limb with a bone without length. Other joints
///   may be between (twist bones): they keep their rotation in their parent and are in no
///   group. A limb's end may also be a segment;
/// - hinges: not unit, or not perpendicular to the limb's upper bone, by more than 1e-3;
/// - limits: two for one joint, min above max, beyond half a turn;
/// - flexibility: an angle outside 0 to pi;
/// - masses and loads: a negative mass or one above 1e6 kg, a position more than 10 km
///   from its joint along an axis, a total mass of 0, a load with a missing or duplicate
///   name.
///
/// Lengths may be zero except those of a limb's two bones, whose directions define its
/// bend. Captured skeletons have vertebrae at one position, avatars a clavicle in the
/// chest or in the arm, a neck in the head, hips in the pelvis, toes in the foot: such
/// joints rotate normally, and the direction of their bone is not used. Masses may be
/// zero except all together; a segment without mass does not move the centre of mass.
[[nodiscard]] Status check_character(const Character& character);

/// Checks that a character can stand: error if no group with can_support has a limb. For
/// callers that use supports. Precondition: check_character() succeeded.
[[nodiscard]] Status check_supports(const Character& character);

}  // namespace marey::retarget
