// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/plant_feet.h"

#include "core/base/frame_range.h"

namespace marey::edit {

/// Report of plant_feet_near().
struct PlantNearReport {
  PlantReport plant;
  FrameRange changed;  ///< Frames whose feet may have moved; last < first: none.
};

/// Makes the feet stand still as plant_feet() does, but only in the stances that touch
/// the frames of `zone`. The displacement of a foot fades out over the swing before its
/// first and after its last such stance, with continuous speed and acceleration; stances
/// that follow within 0.15 s are planted too. Other stances keep their feet. Linear in
/// frames.
/// Precondition: the zone is within the motion.
PlantNearReport plant_feet_near(EditState& state, const FrameRange& zone);

}  // namespace marey::edit
