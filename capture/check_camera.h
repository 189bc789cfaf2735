// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2_device.h"
#include "core/result.h"
#include "core/time.h"

// Of the library marey::v4l2.
namespace marey::capture {

/// Exposures up to this keep a tag's blur under one of its cells at a walker's 2 m/s and
/// 2 m, where nine tags in ten are still found; at twice as much it is four in ten.
constexpr double kSharpExposureSeconds = 0.004;

/// What a camera really does.
struct CameraCheck {
  std::optional<Error> trouble;  ///< It cannot be opened, or gives no frames.
  /// The trouble is only that another program has it.
  bool in_use = false;
  std::optional<DeviceSettings> settings;  ///< When it was opened.
  std::optional<FrameRate> measured;       ///< By its stamps; frames that were dropped
                                           ///< are not frames.
  int frames = 0;
  int dropped = 0;
  int damaged = 0;
  std::vector<std::string> advice;  ///< A sentence each; none when all is well.
};

struct CheckCameraOptions {
  std::chrono::milliseconds patience{3000};  ///< For the first frame.
  std::chrono::milliseconds duration{1000};  ///< Of measuring, from the first frame.
};

/// Opens the camera as `request` says, looks at it for a while, and closes it.
[[nodiscard]] CameraCheck check_camera(const DeviceRequest& request,
                                       const CheckCameraOptions& options = {},
                                       V4l2Kernel& kernel = system_kernel());

/// "MJPG 1280x720 at 29.9 of 30 frames/s, exposure 4 ms": what was chosen, and measured.
/// Of a camera in trouble only the cause.
[[nodiscard]] std::string summary(const CameraCheck& check);

/// "MJPG 1920x1080 (30), 1280x720 (60, 30)": one line for each format.
[[nodiscard]] std::vector<std::string> offers(const DeviceInfo& device);

/// How far the picture of something moves during an exposure, at 2 m/s and 2 m, with a
/// usual lens: one as wide as 1.42 times its focal length. [px]
[[nodiscard]] double blur_px(double exposure_s, int width_px);

}  // namespace marey::capture
