// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/result.h"

// Private to marey::v4l2.
namespace marey::capture {

/// What was being done when the kernel refused.
enum class V4l2Step {
  kOpen,
  kAskWhatItIs,
  kSetFormat,
  kRequestBuffers,
  kMapBuffer,
  kQueueBuffer,
  kStart,
  kTakeFrame,
};

/// The cause that EBUSY becomes.
inline constexpr const char* kInUse = "another program is using it";

/// The refusal `number` (ENOSPC, positive) of a device in words that a user can act on.
[[nodiscard]] Error device_error(const std::string& path, V4l2Step step, int number);

[[nodiscard]] Error not_a_camera(const std::string& path, const std::string& what_it_is);

/// Whether `number` means that the device was unplugged.
[[nodiscard]] bool means_gone(int number);

}  // namespace marey::capture
