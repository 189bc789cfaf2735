// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2_device.h"
#include "capture/v4l2_kernel.h"

// Private to marey::v4l2.
namespace marey::capture {

/// nullopt when marey does not read it.
[[nodiscard]] std::optional<PixelFormat> format_of(std::uint32_t fourcc);

/// The code that the kernel and most drivers use for `format`.
[[nodiscard]] std::uint32_t fourcc_of(PixelFormat format);

/// "H264"; bytes that cannot be shown as '?'.
[[nodiscard]] std::string fourcc_text(std::uint32_t fourcc);

/// What an open capture device offers, of formats that marey reads. Sizes of a driver
/// that gives a range are the usual ones within it.
[[nodiscard]] std::vector<DeviceMode> list_modes(V4l2Kernel& kernel, int fd);

/// Sets format (`fourcc`, the driver's code for `format`), size and rate, and reads back
/// what came of it into `settings`, with a sentence for each difference. Errors
/// (kDevice): busy, gone; the device gives only pictures that marey does not read, or
/// none at all.
[[nodiscard]] Status set_format(V4l2Kernel& kernel,
                                int fd,
                                const DeviceRequest& request,
                                PixelFormat format,
                                std::uint32_t fourcc,
                                DeviceSettings& settings);

}  // namespace marey::capture
