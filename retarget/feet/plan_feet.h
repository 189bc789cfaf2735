// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/floor.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/stand_feet_on.h"

namespace marey::retarget {

/// Plans both feet of a motion: plan_foot_path() on the level floor at world Y =
/// `floor_height_m`, then stand_feet_on() if there is another `floor`, whose heights are
/// relative to that one; without it no displacement. Cost: frames times stances.
/// Precondition: `map` was made from the motion's skeleton; `contacts` has its frames.
[[nodiscard]] std::array<FloorFoot, 2> plan_feet(const Motion& motion,
                                                 const BodyMap& map,
                                                 const Contacts& contacts,
                                                 double floor_height_m = 0.0,
                                                 const Floor* floor = nullptr);

}  // namespace marey::retarget
