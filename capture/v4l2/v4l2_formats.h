// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2/device_types.h"
#include "capture/v4l2/v4l2_kernel.h"
#include "core/base/result.h"

// Private to marey::v4l2.
namespace marey::capture {

/// Returns the format; nullopt if marey does not read it.
[[nodiscard]] std::optional<PixelFormat> format_of(std::uint32_t fourcc);

/// Returns the code that the kernel and most drivers use for `format`.
[[nodiscard]] std::uint32_t fourcc_of(PixelFormat format);

/// Returns "H264"; unprintable bytes become '?'.
[[nodiscard]] std::string fourcc_text(std::uint32_t fourcc);

/// Returns the modes of an open capture device, in formats that marey reads. For a driver
/// with a range of sizes, returns the usual sizes within it.
[[nodiscard]] std::vector<DeviceMode> list_modes(V4l2Kernel& kernel, int fd);

/// Sets format (`fourcc`, the driver's code for `format`), size and rate, and reads the
/// result back into `settings`, with a sentence for each difference. Errors (kDevice):
/// the device is busy or disconnected; it delivers only formats that marey does not read,
/// or none at all.
[[nodiscard]] Status set_format(V4l2Kernel& kernel,
                                int fd,
                                const DeviceRequest& request,
                                PixelFormat format,
                                std::uint32_t fourcc,
                                DeviceSettings& settings);

}  // namespace marey::capture
