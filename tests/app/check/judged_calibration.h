// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/support/simulation/simulated_calibration.h"

namespace marey::testing {

/// The result of `marey calibrate` for a simulated calibration, compared with its truth.
struct JudgedCalibration {
  int exit_code = 0;          ///< 0, 3 (an error) or 4 (a finding that is poor).
  double worst_m = 0.0;       ///< Largest error of a camera's centre; 0 without cameras.
  double worst_sigmas = 0.0;  ///< Largest error of a coordinate, in its sigmas.
  double worst_by_sigma_m = 0.0;  ///< Distance of the camera beyond three sigmas.
  double rms_px = 0.0;
  int beyond_3_sigma = 0;
  int coordinates = 0;
  int turns = 0;            ///< Components of rotation vectors.
  int inside_95 = 0;        ///< Coordinates within 1.96 of their sigmas.
  int turns_inside = 0;     ///< Components of rotation vectors within 1.96 sigmas.
  double body_off_m = 0.0;  ///< Tags of the walk as triangulated: median error.
  bool is_noticed = false;  ///< An exit code other than 0, or a warning that is not
                            ///< about coverage or views.
  bool names_fault =
      false;            ///< A message names the fault, and the camera if it is one's.
  std::string figures;  ///< The inlier RMS, and tests of other hypotheses.
  std::vector<std::string> words;  ///< The error, or findings that are poor or fair.

  /// A camera is more than 10 mm and three sigmas off, or a body 3 mm, and the exit code
  /// is 0.
  [[nodiscard]] bool is_silently_wrong() const {
    return exit_code == 0 && (worst_by_sigma_m > 0.010 || body_off_m > 0.003);
  }
  /// The program rejects good input: it returns no cameras, or reports cameras within
  /// 10 mm as poor.
  [[nodiscard]] bool is_refused_though_good() const { return refused_though_good; }
  bool refused_though_good = false;
};

/// Calibrates as a session without [calibration] asks for, and judges as the program:
/// the cameras, then the trials of a body that follow.
[[nodiscard]] JudgedCalibration judge(const SimulatedCalibration& scene);

}  // namespace marey::testing
