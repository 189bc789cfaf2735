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

/// Moves the world of a rig onto the floor if no board defines the floor, and returns the
/// source of the floor in one sentence. The sources, in this order: the plane of the tags
/// that lie on the floor in the floor trial; the lowest tag of the subject in the static
/// trial, with the up axis estimated from cameras that are assumed to be level; none, and
/// the world stays where it is. The detections are those of CalibrationSights.
///
/// Errors (kBadInput): a floor trial or a static trial from which no floor can be
/// computed.
[[nodiscard]] Result<std::string> stand_on_floor(
    const recordings::Session& session,
    const std::vector<CameraDetections>& floor,
    const std::vector<CameraDetections>& standing,
    calib::CalibratedRig& rig);

/// Checks that the subject of the static trial stands upright on the floor. Passes if no
/// tag of chest or head is seen, or no tag of the lower legs or feet.
///
/// Errors (kBadInput): the subject is tipped over, upside down, or far below the floor.
/// The likely cause is a board that did not lie on the floor, or a mirrored board.
[[nodiscard]] Status check_upright(const recordings::Session& session,
                                   std::span<const Camera> cameras,
                                   const std::vector<CameraDetections>& standing);

}  // namespace marey::app
