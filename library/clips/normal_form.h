// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/library/library_motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Returns the same motion on a skeleton whose rest pose is the canonical T-pose: facing
/// +Z, all joints' axes parallel to the world's (docs/conventions.md). Every joint is at
/// the same place in the world in every frame; marked bones keep their names. Ends of
/// bones (Joint::tip_in_joint) turn with their joints. Linear in frames times joints.
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] Motion in_normal_form(const Motion& motion, const retarget::BodyMap& map);

/// Returns a library's motion: in normal form, with the contacts of the feet. The floor
/// is Y = 0, as the motion has it. Errors (kBadInput): the body has no legs, or there is
/// no pose.
[[nodiscard]] Result<LibraryMotion> make_library_motion(
    const Motion& motion, std::vector<std::vector<JointUncertainty>> uncertainty = {});

/// Returns frames `first` to `last` of a motion. Precondition: they exist.
[[nodiscard]] LibraryMotion part_of(const LibraryMotion& motion, int first, int last);

}  // namespace marey::library
