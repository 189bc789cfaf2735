// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/calibrated_rig.h"
#include "core/detection.h"
#include "core/result.h"
#include "recordings/session.h"

namespace marey::app {

/// The session's cameras, by what they are calibrated with. `floor` is empty when there
/// is no such trial; a wand knows no floor: then the first camera is the world's origin.
/// Errors as calib::calibrate_cameras()'s and calib::calibrate_wand()'s.
[[nodiscard]] Result<calib::CalibratedRig> calibrate_session(
    const recordings::Session& session,
    const std::vector<CameraDetections>& waved,
    const std::vector<CameraDetections>& floor);

}  // namespace marey::app
