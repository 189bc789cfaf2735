// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/model/calibrated_rig.h"
#include "calib/quality/calibration_report.h"
#include "core/board.h"

namespace marey::calib {

/// Origin of a calibration.
struct CalibrationSource {
  std::string session;
  std::string version;
  const CalibrationTarget* target = nullptr;
  double stature_m = 0.0;  ///< 0: unknown.
  double rate_hz = 0.0;    ///< Rate of the first camera's frames.
  /// The world's ground is the floor. Implied by a board on the floor.
  bool has_floor = false;
};

/// Returns the measures, expected errors and findings of a calibrated rig. Cost: 0.1 s
/// for four cameras.
[[nodiscard]] CalibrationReport report_calibration(const CalibrationSource& source,
                                                   CalibratedRig rig);

}  // namespace marey::calib
