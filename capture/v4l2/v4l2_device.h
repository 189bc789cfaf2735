// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2/device_types.h"
#include "core/base/result.h"

// Part of the library marey::v4l2, which links only the C and C++ runtimes: it also runs
// as a static program in a small emulated machine.
namespace marey::capture {

/// Result of the search for cameras.
struct DeviceList {
  std::vector<DeviceInfo> devices;  ///< Video capture devices, by path.
  /// Devices that could not be queried, such as those without permission.
  std::vector<Error> errors;
};

/// Returns all video capture devices. Never fails: a machine without cameras has none.
/// Other devices (outputs, metadata) are omitted.
[[nodiscard]] DeviceList list_devices(V4l2Kernel& kernel = system_kernel());

/// Returns the present path of the camera `lost`: the same card at the same index of the
/// same port, under any path. Returns nullopt while it is not connected there.
[[nodiscard]] std::optional<std::string> find_again(const DeviceInfo& lost,
                                                    V4l2Kernel& kernel = system_kernel());

/// An open, streaming device. One thread at a time.
class V4l2Device {
 public:
  /// Opens the device, applies the settings, reads them back and starts the stream.
  /// Errors (kDevice): no such device; not a capture device; busy; not permitted; none of
  /// the formats; no USB bandwidth left (ENOSPC). Each has a next step. `kernel` must
  /// outlive the device.
  /// Preconditions: positive size, rate and number of buffers.
  [[nodiscard]] static Result<V4l2Device> open(const DeviceRequest& request,
                                               V4l2Kernel& kernel = system_kernel());

  V4l2Device(V4l2Device&&) noexcept;
  V4l2Device& operator=(V4l2Device&&) noexcept;
  ~V4l2Device();

  /// Returns the next frame, or nullopt if none arrived within `timeout`. Errors
  /// (kDevice): the device is disconnected (unplugged), or fails permanently; open it
  /// again. Stale buffers from before the start are skipped. Allocates nothing unless it
  /// fails.
  [[nodiscard]] Result<std::optional<RawFrame>> next(std::chrono::milliseconds timeout);

  [[nodiscard]] const DeviceInfo& info() const;
  [[nodiscard]] const DeviceSettings& settings() const;

 private:
  struct Impl;
  explicit V4l2Device(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
