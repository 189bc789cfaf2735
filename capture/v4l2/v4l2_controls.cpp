// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_controls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <linux/videodev2.h>

namespace marey::capture {
namespace {

/// EXPOSURE_ABSOLUTE counts in 100 µs.
constexpr double kExposureUnitSeconds = 1e-4;

std::optional<v4l2_queryctrl> describe(V4l2Kernel& kernel, int fd, std::uint32_t id) {
  v4l2_queryctrl control{};
  control.id = id;
  if (kernel.ioctl(fd, VIDIOC_QUERYCTRL, &control) < 0) return std::nullopt;
  if ((control.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
  return control;
}

void set(V4l2Kernel& kernel, int fd, std::uint32_t id, int value) {
  const auto control = describe(kernel, fd, id);
  if (!control || (control->flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) return;
  v4l2_control wanted{};
  wanted.id = id;
  wanted.value = control->type == V4L2_CTRL_TYPE_INTEGER && control->maximum > 0
                     ? std::clamp(value, control->minimum, control->maximum)
                     : value;
  kernel.ioctl(fd, VIDIOC_S_CTRL, &wanted);
}

std::optional<int> get(V4l2Kernel& kernel, int fd, std::uint32_t id) {
  if (!describe(kernel, fd, id)) return std::nullopt;
  v4l2_control now{};
  now.id = id;
  if (kernel.ioctl(fd, VIDIOC_G_CTRL, &now) < 0) return std::nullopt;
  return now.value;
}

std::string text_in_ms(double time_s) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g ms", 1e3 * time_s);
  return text.data();
}

void compare_exposure(double asked_s, DeviceSettings& settings) {
  const std::string asked = "requested an exposure of " + text_in_ms(asked_s);
  if (!settings.exposure_s) {
    settings.differences.push_back(asked + ", and the camera has no such control");
  } else if (settings.exposure_is_automatic) {
    settings.differences.push_back(asked + ", and the camera keeps it automatic");
  } else if (std::abs(*settings.exposure_s - asked_s) > 1.001 * kExposureUnitSeconds) {
    settings.differences.push_back(asked + ", got " + text_in_ms(*settings.exposure_s));
  }
}

void compare(const char* what,
             std::optional<int> asked,
             std::optional<int> got,
             std::vector<std::string>& differences) {
  if (!asked || asked == got) return;
  differences.push_back(
      "requested a " + std::string(what) + " of " + std::to_string(*asked) +
      (got ? ", got " + std::to_string(*got) : ", and the camera has no such control"));
}

}  // namespace

void set_controls(V4l2Kernel& kernel, int fd, const DeviceRequest& request) {
  if (request.exposure_s) {
    set(kernel, fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    // "Exposure, dynamic framerate": in dim light it halves the rate.
    set(kernel, fd, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
    const long units = std::lround(*request.exposure_s / kExposureUnitSeconds);
    set(kernel,
        fd,
        V4L2_CID_EXPOSURE_ABSOLUTE,
        static_cast<int>(std::clamp(units, 1L, 1'000'000L)));
  }
  if (request.focus) {
    set(kernel, fd, V4L2_CID_FOCUS_AUTO, 0);
    set(kernel, fd, V4L2_CID_FOCUS_ABSOLUTE, *request.focus);
  }
  if (request.gain) {
    set(kernel, fd, V4L2_CID_AUTOGAIN, 0);
    set(kernel, fd, V4L2_CID_GAIN, *request.gain);
  }
}

void read_controls(V4l2Kernel& kernel,
                   int fd,
                   const DeviceRequest& request,
                   DeviceSettings& settings) {
  if (const auto units = get(kernel, fd, V4L2_CID_EXPOSURE_ABSOLUTE)) {
    settings.exposure_s = *units * kExposureUnitSeconds;
  }
  // Shutter priority leaves the exposure to the user, and only the aperture is automatic.
  const auto mode = get(kernel, fd, V4L2_CID_EXPOSURE_AUTO);
  settings.exposure_is_automatic =
      mode == V4L2_EXPOSURE_AUTO || mode == V4L2_EXPOSURE_APERTURE_PRIORITY;
  settings.focus = get(kernel, fd, V4L2_CID_FOCUS_ABSOLUTE);
  settings.gain = get(kernel, fd, V4L2_CID_GAIN);
  if (request.exposure_s) compare_exposure(*request.exposure_s, settings);
  compare("focus", request.focus, settings.focus, settings.differences);
  compare("gain", request.gain, settings.gain, settings.differences);
}

}  // namespace marey::capture
