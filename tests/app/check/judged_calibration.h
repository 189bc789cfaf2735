// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/support/simulation/simulated_calibration.h"

namespace marey::testing {

/// What `marey calibrate` makes of a simulated calibration, held against its truth.
struct JudgedCalibration {
  int exit_code = 0;          ///< 0, 3 (an error) or 4 (a finding that is poor).
  double worst_m = 0.0;       ///< Of the cameras' centres; 0 where there are no cameras.
  double worst_sigmas = 0.0;  ///< Of their coordinates, in their own sigmas.
  double worst_by_sigma_m = 0.0;  ///< Distance of the camera beyond three sigmas.
  double rms_px = 0.0;
  int beyond_3_sigma = 0;
  int coordinates = 0;
  int turns = 0;            ///< Components of rotation vectors.
  int inside_95 = 0;        ///< Coordinates within 1.96 of their sigmas.
  int turns_inside = 0;     ///< Likewise of rotation vectors.
  double body_off_m = 0.0;  ///< Tags of the walk as triangulated: median error.
  bool is_noticed = false;  ///< An exit code other than 0, or a warning that is not
                            ///< about coverage or views.
  bool names_fault =
      false;            ///< A message names the fault, and the camera if it is one's.
  std::string figures;  ///< Of its tests of other hypotheses.
  std::vector<std::string> words;  ///< The error, or findings that are poor or fair.

  /// A camera is more than 10 mm and three sigmas off, or a body 3 mm, and the exit code
  /// is 0.
  [[nodiscard]] bool is_silently_wrong() const {
    return exit_code == 0 && (worst_by_sigma_m > 0.010 || body_off_m > 0.003);
  }
  /// Cameras within 5 mm that were not let pass, or none where nothing was wrong.
  [[nodiscard]] bool is_refused_though_good() const { return refused_though_good; }
  bool refused_though_good = false;
};

/// Calibrates as a session without [calibration] asks for, and judges as the program:
/// the cameras, then the trials of a body that follow.
[[nodiscard]] JudgedCalibration judge(const SimulatedCalibration& scene);

}  // namespace marey::testing
