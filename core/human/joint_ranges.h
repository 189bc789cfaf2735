// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/character_spec.h"
#include "core/humanoid.h"

namespace marey {

/// Returns the range of rotation of an adult's bone in its parent, from the T-pose (palms
/// down) and in its axes. nullopt: the hips, which have no parent, and spine, chest and
/// upper chest, which share spine_range().
///
/// Sources: the normal ranges of the American Academy of Orthopaedic Surgeons ("Joint
/// Motion", 1965, as in Norkin and White, "Measurement of Joint Motion", appendix); neck
/// and head by the AMA's "Guides to the Evaluation of Permanent Impairment"; clavicles by
/// Neumann, "Kinesiology of the Musculoskeletal System". Each has a margin of 15 degrees,
/// because half of all people exceed the mean, and because axes are limited separately
/// while people combine them. Elbows and knees flex from -5 to 150 degrees; their other
/// rotations are almost free, as is the axis that skeletons divide between forearm and
/// hand.
[[nodiscard]] std::optional<BoneLimit> joint_range(HumanBone bone);

/// Returns the range of one vertebra of a spine with `count` vertebrae: twice its share
/// of the whole, limited to the whole, because skeletons bend their spines in different
/// places. Precondition: count > 0.
[[nodiscard]] BoneLimit spine_range(int count);

}  // namespace marey
