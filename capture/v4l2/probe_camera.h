// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2/v4l2_device.h"
#include "core/base/result.h"
#include "core/base/time.h"

// Part of the library marey::v4l2.
namespace marey::capture {

/// Longest exposure at which a tag's blur is below one of its cells at a walker's 2 m/s
/// and 2 m: 90 % of the tags are still detected. At twice this exposure it is 40 %.
constexpr double kSharpExposureSeconds = 0.004;

/// Measured behaviour of a camera.
struct CameraProbe {
  std::optional<Error> trouble;  ///< It cannot be opened, or delivers no frames.
  /// The only trouble is that another program uses it.
  bool in_use = false;
  std::optional<DeviceSettings> settings;  ///< Settings after opening.
  std::optional<FrameRate> measured;  ///< By its time stamps, without dropped frames.
  int frames = 0;
  int dropped = 0;
  int damaged = 0;
  std::vector<std::string> advice;  ///< One sentence each; empty if there is no problem.
};

struct ProbeCameraOptions {
  std::chrono::milliseconds patience{3000};  ///< Waiting time for the first frame.
  /// Duration of the measurement, from the first frame.
  std::chrono::milliseconds duration{1000};
};

/// Opens the camera with `request`, measures for a while, and closes it.
[[nodiscard]] CameraProbe probe_camera(const DeviceRequest& request,
                                       const ProbeCameraOptions& options = {},
                                       V4l2Kernel& kernel = system_kernel());

/// Returns "MJPG 1280x720 at 29.9 of 30 frames/s, exposure 4 ms": the chosen settings and
/// the measured rate. Returns only the cause for a camera in trouble.
[[nodiscard]] std::string summary(const CameraProbe& probe);

/// Returns "MJPG 1920x1080 (30), 1280x720 (60, 30)": one line for each format.
[[nodiscard]] std::vector<std::string> offers(const DeviceInfo& device);

/// Returns the displacement in the image of an object during an exposure, at 2 m/s and 2
/// m, with a usual lens: the image width is 1.42 times the focal length. [px]
[[nodiscard]] double blur_px(double exposure_s, int width_px);

}  // namespace marey::capture
