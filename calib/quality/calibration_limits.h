// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "calib/quality/calibration_report.h"
#include "core/camera.h"

namespace marey::calib {

/// Limits of the measures of a calibration. Each pair is {limit of good, limit of
/// usable}: a value between the two is a fair finding, a value beyond the second a poor
/// one.
struct CalibrationLimits {
  std::array<double, 2> error_m;
  std::array<double, 2> residual_px;
  std::array<double, 2> coverage;
  int shared_instants;  ///< Instants with a view of the target from two or more cameras.
};
/// Webcams in focus reach 0.1 to 0.5 px. About one pixel indicates blur, a bent print or
/// clocks that differ by a frame. Three pixels indicate another board, another video or a
/// moved camera.
inline constexpr std::array<double, 2> kResidualLimitsPx{0.5, 3.0};
/// A board that was waved through the whole volume covers a third to a half of an image.
/// If it covers less than a sixteenth, the lens is unconstrained in the rest of the
/// image.
inline constexpr std::array<double, 2> kCoverageLimits{0.3, 0.0625};
/// Smallest good number of instants that two cameras share. With fewer, one wrong pose of
/// the board changes their relative pose.
inline constexpr int kFairShared = 8;

/// Returns the limits of a report. Those of errors are 8 and 20 mm at a distance of 3 m
/// from the cameras to the middle of the volume (CalibrationMap::distance_m), and scale
/// with it.
[[nodiscard]] CalibrationLimits limits_of(const CalibrationReport& report);

/// Returns the factor for limits in pixels of this camera: 1 up to an image width of 1920
/// px, else width / 1920, because the same blur covers more pixels of a larger image.
[[nodiscard]] inline double pixel_scale(const Camera& camera) {
  const double width_px = camera.intrinsics.width_px;
  return width_px > 1920.0 ? width_px / 1920.0 : 1.0;
}

}  // namespace marey::calib
