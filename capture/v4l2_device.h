// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"

// Of the library marey::v4l2, which links nothing but the C and C++ runtimes: it also
// runs as a static program in a small emulated machine.
namespace marey::capture {

/// The system calls behind all this (capture/v4l2_kernel.h). Only tests bring their own.
class V4l2Kernel;
[[nodiscard]] V4l2Kernel& system_kernel();

/// How a device packs its pictures, in the order in which they are preferred.
enum class PixelFormat { kMjpg, kYuyv, kNv12, kGrey };

/// "MJPG", "YUYV", "NV12", "GREY".
[[nodiscard]] const char* name(PixelFormat format);

struct DeviceMode {
  PixelFormat format = PixelFormat::kMjpg;
  int width_px = 0;  ///< 0 by 0 when the driver does not list its sizes.
  int height_px = 0;
  std::vector<FrameRate> rates;  ///< Fastest first; empty when the driver does not list.
  /// The driver's own code: motion JPEG goes by two names.
  std::uint32_t fourcc = 0;
};

/// A capture device as the kernel lists it.
struct DeviceInfo {
  std::string path;    ///< "/dev/video0".
  std::string card;    ///< What it calls itself: "HD Webcam C920".
  std::string bus;     ///< Where it is plugged in; the same again after a replug.
  std::string driver;  ///< "uvcvideo".
  /// Which of the capture devices at that bus: cameras with two lenses have two.
  int place_at_bus = 0;
  std::vector<DeviceMode> modes;  ///< Of formats that marey reads.
};

/// What was found when looking for cameras.
struct DeviceList {
  std::vector<DeviceInfo> devices;  ///< Video capture devices, by path.
  /// Devices that would not say what they are, such as those that may not be opened.
  std::vector<Error> troubles;
};

/// All video capture devices. Never fails: a machine without cameras has none. Devices
/// that are something else (outputs, metadata) are left out.
[[nodiscard]] DeviceList list_devices(V4l2Kernel& kernel = system_kernel());

/// Where the camera `lost` is now: the same card at the same place of the same bus, under
/// whatever path. nullopt while it is not plugged in there.
[[nodiscard]] std::optional<std::string> find_again(const DeviceInfo& lost,
                                                    V4l2Kernel& kernel = system_kernel());

struct DeviceRequest {
  std::string path;
  int width_px = 1280;
  int height_px = 720;
  FrameRate rate{30.0};
  std::optional<PixelFormat> format;  ///< nullopt: choose_format().
  /// nullopt leaves each to the camera. Exposure [s]; focus and gain in the driver's own
  /// units, which mean nothing outside of it.
  std::optional<double> exposure_s;
  std::optional<int> focus;
  std::optional<int> gain;
  int buffers = 4;
};

/// What open() asks for when the request names no format: the first of the preference
/// that has the size at the rate, or else the size, or else anything. nullopt when the
/// device has none that marey reads.
[[nodiscard]] std::optional<PixelFormat> choose_format(const DeviceInfo& device,
                                                       const DeviceRequest& request);

/// What the device really does, read back from it.
struct DeviceSettings {
  PixelFormat format = PixelFormat::kMjpg;
  int width_px = 0;
  int height_px = 0;
  int stride = 0;       ///< Bytes per row of the first plane; 0 for MJPG.
  FrameRate rate{0.0};  ///< 0 when the driver does not say.
  std::optional<double> exposure_s;
  bool exposure_is_automatic = false;
  std::optional<int> focus;
  std::optional<int> gain;
  int buffers = 0;
  /// Whether the driver promises that time stamps are CLOCK_MONOTONIC.
  bool monotonic_clock = false;
  /// What was asked for and is not so, a sentence each: "asked for MJPG, got YUYV".
  std::vector<std::string> differences;
};

/// One picture as the device packed it. Borrowed: valid until the next call.
struct RawFrame {
  std::span<const std::byte> bytes;
  /// The kernel's, CLOCK_MONOTONIC; may lie slightly in the future.
  Timestamp time{0};
  /// The driver's stamp made no sense, and `time` is when the frame arrived.
  bool time_is_arrival = false;
  std::uint32_t sequence = 0;
  /// Frames that the device made and nobody got, since the last. Frames from before the
  /// stream was started do not count.
  int dropped_before = 0;
  bool damaged = false;  ///< The driver says that its content may be wrong, or missing.
};

/// An open, streaming device. One thread at a time.
class V4l2Device {
 public:
  /// Opens, sets, reads back and starts. Errors (kDevice): no such device; not a capture
  /// device; busy; not permitted; none of the formats; no USB bandwidth left (ENOSPC);
  /// each with what to do. `kernel` must outlive the device.
  /// Preconditions: positive size, rate and number of buffers.
  [[nodiscard]] static Result<V4l2Device> open(const DeviceRequest& request,
                                               V4l2Kernel& kernel = system_kernel());

  V4l2Device(V4l2Device&&) noexcept;
  V4l2Device& operator=(V4l2Device&&) noexcept;
  ~V4l2Device();

  /// The next frame, or nullopt when none came within `timeout`. Errors (kDevice): the
  /// device is gone (unplugged), or fails for good; open it anew. Stale buffers from
  /// before the start are skipped. Allocates nothing unless it fails.
  [[nodiscard]] Result<std::optional<RawFrame>> next(std::chrono::milliseconds timeout);

  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] const DeviceSettings& settings() const;

 private:
  struct Impl;
  explicit V4l2Device(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
