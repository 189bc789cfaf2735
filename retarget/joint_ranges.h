// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/character.h"
#include "core/character_spec.h"
#include "core/humanoid.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// How far a bone of an adult turns in its parent, from the T-pose (palms down) and in
/// its axes. nullopt: the hips, which hang on nothing, and spine, chest and upper chest,
/// which share spine_range().
///
/// What the American Academy of Orthopaedic Surgeons calls normal ("Joint Motion", 1965,
/// as in Norkin and White, "Measurement of Joint Motion", appendix), neck and head by the
/// AMA's "Guides to the Evaluation of Permanent Impairment", clavicles by Neumann,
/// "Kinesiology of the Musculoskeletal System"; each 15 degrees more, since half of all
/// people turn further than the mean, and since axes are limited one by one while people
/// mix them. Elbows and knees bend from -5 to 150 degrees; what
/// turns beside that hinge is left nearly free, as is the axis that skeletons share out
/// between forearm and hand.
[[nodiscard]] std::optional<BoneLimit> joint_range(HumanBone bone);

/// Of one vertebra when the spine has `count`: twice its share of the whole, but no more
/// than the whole, because no two skeletons bend their spines in the same place.
/// Precondition: count > 0.
[[nodiscard]] BoneLimit spine_range(int count);

/// The limits of a body's joints: of its bones and of its vertebrae, marked or not. What
/// `traits` gives for a bone comes in place of that, also when it wants no others.
[[nodiscard]] std::vector<JointLimit> joint_limits(const BodyMap& map,
                                                   const CharacterTraits& traits);

}  // namespace marey::retarget
