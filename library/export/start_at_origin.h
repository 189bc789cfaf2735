// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Turns a motion about the vertical and moves it level, so that in its first frame the
/// hips are over the origin and the body faces +Z (level_frame()). Heights stay. Does
/// nothing without poses. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton.
void start_at_origin(Motion& motion, const retarget::BodyMap& map);

}  // namespace marey::library
