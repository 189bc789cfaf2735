// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "dynamics/jumps/jump.h"

#include "core/finding.h"
#include "core/motion.h"

namespace marey::app {

/// Finds the jumps of a motion in marey's frame, with the masses of an average adult
/// (de Leva). Empty: the body never leaves the floor. nullopt: the body has no legs or
/// other bones that are needed, or the motion has fewer than four frames or a number that
/// is not finite. Linear in frames.
[[nodiscard]] std::optional<std::vector<dynamics::Jump>> find_motion_jumps(
    const Motion& motion);

/// Returns the findings of a jump, with "jump N" as the place. They state among others a
/// captured fall that differs from gravity. `number` is the jump's, from 1.
[[nodiscard]] std::vector<Finding> findings_of_jump_number(const dynamics::Jump& jump,
                                                           int number);

}  // namespace marey::app
