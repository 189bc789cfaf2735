// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"

// Part of the library marey::v4l2: capture devices, their settings and their frames.
namespace marey::capture {

/// Interface to the system calls (capture/v4l2/v4l2_kernel.h). Only tests use another
/// implementation.
class V4l2Kernel;
[[nodiscard]] V4l2Kernel& system_kernel();

/// Pixel format of a device's images, in the order of preference.
enum class PixelFormat { kMjpg, kYuyv, kNv12, kGrey };

/// "MJPG", "YUYV", "NV12", "GREY".
[[nodiscard]] const char* name(PixelFormat format);

struct DeviceMode {
  PixelFormat format = PixelFormat::kMjpg;
  int width_px = 0;  ///< 0 by 0 if the driver does not list its sizes.
  int height_px = 0;
  /// Fastest first; empty if the driver does not list them.
  std::vector<FrameRate> rates;
  /// The driver's own code: motion JPEG has two names.
  std::uint32_t fourcc = 0;
};

/// A capture device as the kernel lists it.
struct DeviceInfo {
  std::string path;    ///< "/dev/video0".
  std::string card;    ///< The device's own name: "HD Webcam C920".
  std::string bus;     ///< Its port; unchanged after a replug into the same port.
  std::string driver;  ///< "uvcvideo".
  /// Index among the capture devices at that port: cameras with two lenses have two.
  int place_at_bus = 0;
  std::vector<DeviceMode> modes;  ///< Modes in formats that marey reads.
};

struct DeviceRequest {
  std::string path;
  int width_px = 1280;
  int height_px = 720;
  FrameRate rate{30.0};
  std::optional<PixelFormat> format;  ///< nullopt: choose_format().
  /// nullopt leaves the setting to the camera. Exposure [s]; focus and gain in the
  /// driver's own units, which differ between drivers.
  std::optional<double> exposure_s;
  std::optional<int> focus;
  std::optional<int> gain;
  int buffers = 4;
};

/// Returns the default format of open() if the request names none: the first in the order
/// of preference with the size at the rate, otherwise with the size, otherwise any.
/// Returns nullopt if the device has no format that marey reads.
[[nodiscard]] std::optional<PixelFormat> choose_format(const DeviceInfo& device,
                                                       const DeviceRequest& request);

/// Actual settings of the device, read back from it.
struct DeviceSettings {
  PixelFormat format = PixelFormat::kMjpg;
  int width_px = 0;
  int height_px = 0;
  int stride = 0;       ///< Bytes per row of the first plane; 0 for MJPG.
  FrameRate rate{0.0};  ///< 0 if the driver does not report it.
  std::optional<double> exposure_s;
  bool exposure_is_automatic = false;
  std::optional<int> focus;
  std::optional<int> gain;
  int buffers = 0;
  /// The driver guarantees that time stamps are CLOCK_MONOTONIC.
  bool monotonic_clock = false;
  /// Differences from the request, a sentence each: "asked for MJPG, got YUYV".
  std::vector<std::string> differences;
};

/// One image as packed by the device. Borrowed: valid until the next call.
struct RawFrame {
  std::span<const std::byte> bytes;
  /// The kernel's time stamp, CLOCK_MONOTONIC; may be slightly in the future.
  Timestamp time{0};
  /// The driver's time stamp was invalid, and `time` is the arrival of the frame.
  bool time_is_arrival = false;
  std::uint32_t sequence = 0;
  /// Frames that the device produced and the driver lost since the last frame. Frames
  /// from before the start of the stream do not count.
  int dropped_before = 0;
  bool damaged = false;  ///< The driver reports that its content may be wrong or missing.
};

}  // namespace marey::capture
