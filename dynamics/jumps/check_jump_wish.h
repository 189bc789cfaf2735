// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/jump_wish.h"

#include "core/base/result.h"

namespace marey::dynamics {

/// Flights shorter than this are not planned. [s]
inline constexpr double kShortestFlight_s = 0.02;

/// Checks a wish without solving anything. Errors (bad input): numbers that are not
/// finite or out of range; wishes that exclude each other; a wish on a landing that the
/// clip does not have.
[[nodiscard]] Status check_jump_wish(const JumpReference& reference,
                                     const JumpWish& wish,
                                     const JumpTraits& traits,
                                     const PlanJumpOptions& options);

}  // namespace marey::dynamics
