// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Returns the world height (Y) of the floor under a motion, for any origin. [m]
///
/// It is the 5 % quantile of the height of the lower sole (FootMap) over the frames in
/// which a foot bears: retarget::detect_contacts() has a stance, the foot is below the
/// hips and does not point up by more than 40 degrees, and the body does not fall. On
/// stairs this is the lowest step on which at least 5 % of these frames stand.
///
/// A body falls while its centre of mass accelerates downwards by more than half of
/// gravity, over 0.2 s; in a motion shorter than that it never does.
///
/// A motion in which no foot bears (sitting or lying on the floor, standing on the hands,
/// touchdowns too short for a contact) has the 5 % quantile of the lowest point of the
/// body's surface (retarget::average_volume(), soles) over the frames in which the body
/// does not fall. Whatever supports the body is taken for the floor, also a chair.
///
/// nullopt: there are no poses, or the body falls all the time.
/// Linear in frames times joints; allocates per frame. Preconditions: `map` was made from
/// the motion's skeleton; the rate is positive.
[[nodiscard]] std::optional<double> floor_height_m(const Motion& motion,
                                                   const retarget::BodyMap& map);

/// Moves a motion vertically so that its floor is at Y = 0, and returns the added height
/// [m]: 0, and no change, if the floor is unknown. Cost and preconditions:
/// floor_height_m().
double put_on_floor(Motion& motion, const retarget::BodyMap& map);

}  // namespace marey::library
