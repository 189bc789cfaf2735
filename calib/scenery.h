// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: tags that happen to be about.

#include <span>

#include "calib/rig_model.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Adds, as a target that stays, the tags that are none of the wand's and rest in the
/// pictures of two cameras or more; sizes unknown. One averaged sighting per camera and
/// tag: its sigma does not fall below three quarters of one detection's. Adds no target
/// where there are none. A tag that some camera sees in two places is left out.
void add_scenery(std::span<const CameraDetections> waved,
                 const Wand& wand,
                 RigModel& model);

}  // namespace marey::calib
