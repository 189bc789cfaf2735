// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/jumps/jump.h"
#include "dynamics/jumps/jump_wish.h"
#include <glm/vec3.hpp>

namespace marey::dynamics {

/// Returns the displacement of the landing that a wish asks for: 0 without a wish on the
/// landing, or where its feet are unknown. World axes. [m]
[[nodiscard]] glm::dvec3 landing_moved(const Jump& jump, const JumpWish& wish);

}  // namespace marey::dynamics
