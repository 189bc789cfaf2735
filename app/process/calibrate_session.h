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

/// Detections of the trials that the cameras are calibrated from. Each vector has one
/// entry per camera, or is empty if the session has no such trial.
struct CalibrationSights {
  std::vector<CameraDetections> waved;
  std::vector<CameraDetections> floor;
  std::vector<CameraDetections> standing;  ///< Detections of the static trial.
};

struct SessionRig {
  calib::CalibratedRig rig;
  bool has_floor = false;  ///< A floor trial or a static trial gave the floor.
  /// Findings and decisions of the calibration, one sentence each.
  std::vector<std::string> notes;
};

/// Calibrates the cameras of a session with its target, as [calibration] requires. The
/// world stands on the floor of the floor trial; without one, on the floor of the subject
/// in the static trial; without either, the first camera is the world's origin.
///
/// Errors: those of calib::calibrate_cameras(), calib::calibrate_wand() and
/// stand_on_floor(); a file of lenses that cannot be read, that contains none of the
/// cameras, or that was made for another picture size.
[[nodiscard]] Result<SessionRig> calibrate_session(const recordings::Session& session,
                                                   const CalibrationSights& sights,
                                                   const Progress& progress = {});

}  // namespace marey::app
