// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/result.h"

// Private to marey::v4l2.
namespace marey::capture {

/// The operation that failed in the kernel.
enum class V4l2Step {
  kOpen,
  kQueryCapabilities,
  kSetFormat,
  kRequestBuffers,
  kMapBuffer,
  kQueueBuffer,
  kStart,
  kTakeFrame,
};

/// Returns an error message with a next step for the errno `number` (ENOSPC, positive) of
/// a device. Error::os_error is the number.
[[nodiscard]] Error device_error(const std::string& path, V4l2Step step, int number);

[[nodiscard]] Error not_a_camera(const std::string& path, const std::string& what_it_is);

/// Returns true if the errno `number` means that the device was unplugged.
[[nodiscard]] bool is_disconnect_errno(int number);

}  // namespace marey::capture
