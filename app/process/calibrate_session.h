// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "calib/model/calibrated_rig.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// What was seen in the trials that cameras are calibrated from. Each has one entry per
/// camera, or is empty when there is no such trial.
struct CalibrationSights {
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;
  std::vector<CameraDetections> standing;  ///< Of the static trial.
};

struct SessionRig {
  calib::CalibratedRig rig;
  bool has_floor = false;  ///< The world's ground is the floor, by whatever told it.
  /// What was found out or decided, a sentence each.
  std::vector<std::string> notes;
};

/// The session's cameras, by what they are calibrated with, as [calibration] asks for it,
/// in a world that stands on the floor: the floor trial's; else that of the subject who
/// stands still; else the first camera is the world's origin.
///
/// Errors as calib::calibrate_cameras()'s and calib::calibrate_wand()'s; as
/// stand_on_floor()'s; lenses whose file cannot be read, or is of
/// none of the cameras, or of pictures of another size.
[[nodiscard]] Result<SessionRig> calibrate_session(const recordings::Session& session,
                                                   const CalibrationSights& sights,
                                                   const Progress& progress = {});

}  // namespace marey::app
