// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "calib/quality/calibration_report.h"

namespace marey::calib {

/// The moving board in one frame of a camera.
struct PassingView {
  int frame = 0;
  glm::dvec2 velocity_px{0.0};  ///< Velocity of its middle, per frame.
  glm::dvec2 error_px{0.0};     ///< Seen minus expected, the median of its corners.
  bool is_shared = false;       ///< Another camera saw it in a frame of that number.
};

/// Returns the views of one target, in the order of frames, whose neighbours in the
/// camera's `views` are near enough to compute a velocity.
[[nodiscard]] std::vector<PassingView> passing_views(
    const CalibrationReport& report,
    const Camera& camera,
    const std::vector<const TargetView*>& views);

/// Fits errors to velocity as a straight line through zero: e = lag * velocity. Returns
/// nullopt for fewer than ten views, or for a board at rest.
[[nodiscard]] std::optional<CameraLag> lag_of(const std::vector<PassingView>& views);

/// Returns the frame at which a camera's lag changes significantly, if any.
[[nodiscard]] std::optional<CameraSlip> slip_of(const std::vector<PassingView>& views);

}  // namespace marey::calib
