// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/model/calibrated_rig.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Moves the rig's world onto a floor that no board tells, and says where it came from:
/// the plane of the tags that lie in the floor trial; else the lowest tag of the subject
/// who stands still, up being across the cameras, which are held to stand level; else it
/// stays where it is. Sights as CalibrationSights's.
///
/// Errors (kBadInput): a floor or static trial that tells no floor.
[[nodiscard]] Result<std::string> stand_on_floor(
    const recordings::Session& session,
    const std::vector<CameraDetections>& floor,
    const std::vector<CameraDetections>& standing,
    calib::CalibratedRig& rig);

/// Whether the subject who stands still stands upright on the floor. Says nothing when
/// no tag of chest or head is seen, or none of the lower legs or feet.
///
/// Errors (kBadInput): the subject is tipped over or upside down, or far below the floor:
/// the board lay elsewhere than on the floor, or was mirrored.
[[nodiscard]] Status check_upright(const recordings::Session& session,
                                   std::span<const Camera> cameras,
                                   const std::vector<CameraDetections>& standing);

}  // namespace marey::app
