// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "app/calibration_report.h"
#include "core/camera.h"

namespace marey::app {

/// What figures are measured against. The first of a pair is the end of good, the second
/// of what can be used.
struct CalibrationLimits {
  std::array<double, 2> error_m;
  std::array<double, 2> residual_px;
  std::array<double, 2> coverage;
  int shared_instants;  ///< At which two cameras should see it together, or more.
};
/// Webcams in focus end at 0.1 to 0.5 px; a pixel is blur, a bent print or clocks that
/// are a frame apart; three are another board, another video, or a camera that moved.
inline constexpr std::array<double, 2> kResidualLimitsPx{0.5, 3.0};
/// A board that was waved through all of the volume fills a third to a half of a picture.
/// Seen in less than a sixteenth of it, a lens is a guess everywhere else.
inline constexpr std::array<double, 2> kCoverageLimits{0.3, 0.0625};
/// Two cameras joined by that many instants: one slip of the board moves them.
inline constexpr int kFairShared = 8;
[[nodiscard]] CalibrationLimits limits_of(const CalibrationReport& report);

/// By how much pixel limits are larger for this camera: they are for pictures up to
/// 1920 px wide, and the same lens and hand blur more pixels of a larger one.
[[nodiscard]] inline double pixel_scale(const Camera& camera) {
  const double width_px = camera.intrinsics.width_px;
  return width_px > 1920.0 ? width_px / 1920.0 : 1.0;
}

}  // namespace marey::app
