// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/camera_quality.h"

namespace marey::recordings {

/// A camera's clock relative to the first camera's.
struct CameraClock {
  double offset_s = 0.0;  ///< Frame k was exposed at k / rate + offset.
  double drift_ppm = 0.0;
  double line_delay_s = 0.0;  ///< Delay between consecutive rows of the image.
};

/// Content of calibration.toml.
struct Calibration {
  std::vector<Camera> cameras;
  std::vector<CameraQuality> quality;  ///< Per camera.
  std::vector<CameraClock> clocks;     ///< Per camera.
  double rms_px = 0.0;                 ///< Over all corners of all cameras.
};

}  // namespace marey::recordings
