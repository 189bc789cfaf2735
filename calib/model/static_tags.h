// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: static tags of the scene that belong to neither wand nor board.

#include <span>

#include "calib/model/rig_model.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Adds, as a static target, the tags that do not belong to the wand and are at rest in
/// the images of two or more cameras; their sizes are unknown. Adds one averaged sighting
/// per camera and tag, whose sigma is at least three quarters of a single detection's.
/// Adds no target if there are no such tags. A tag that some camera sees in two places is
/// excluded.
void add_static_tags(std::span<const CameraDetections> waved,
                     const Wand& wand,
                     RigModel& model);

}  // namespace marey::calib
