// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "app/calibration_report.h"

namespace marey::app {

/// The moving board in one frame of a camera.
struct PassingView {
  int frame = 0;
  glm::dvec2 velocity_px{0.0};  ///< Of its middle, per frame.
  glm::dvec2 error_px{0.0};     ///< Seen less expected, the median of its corners.
  bool is_shared = false;       ///< Another camera saw it in a frame of that number.
};

/// Of a camera's `views` of one target, in the order of frames, those whose neighbours
/// are near enough to tell how fast it went.
[[nodiscard]] std::vector<PassingView> passing_views(
    const CalibrationReport& report,
    const Camera& camera,
    const std::vector<const calib::TargetView*>& views);

/// Errors against movement, as a straight line through zero: e = lag * velocity. nullopt
/// of fewer than ten views, or of a board at rest.
[[nodiscard]] std::optional<CameraLag> lag_of(const std::vector<PassingView>& views);

/// The frame from which on a camera's lag is another one, where it clearly is.
[[nodiscard]] std::optional<CameraSlip> slip_of(const std::vector<PassingView>& views);

}  // namespace marey::app
