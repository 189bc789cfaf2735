// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/time.h"

// Private to marey::v4l2 and its tests.
namespace marey::capture {

/// The system calls that a camera needs; tests replace them to inject faults. All return
/// a negative errno, such as -ENODEV, on failure; none throws.
/// The system implementation is stateless and thread-safe.
class V4l2Kernel {
 public:
  virtual ~V4l2Kernel() = default;

  /// Opens for reading and writing, not blocking.
  [[nodiscard]] virtual int open(const std::string& path) = 0;
  virtual int close(int fd) = 0;
  /// Retries after a signal.
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// Returns the set bits of POLLIN, POLLERR and POLLHUP; 0 after the timeout.
  [[nodiscard]] virtual int poll(int fd, std::chrono::milliseconds timeout) = 0;
  /// Returns nullptr on failure.
  [[nodiscard]] virtual std::byte* map(int fd, std::size_t size, std::int64_t offset) = 0;
  virtual void unmap(std::byte* memory, std::size_t size) = 0;
  /// Returns the paths of all video devices, by number: /dev/video2 comes before
  /// /dev/video10.
  [[nodiscard]] virtual std::vector<std::string> video_paths() = 0;
  /// Returns CLOCK_MONOTONIC.
  [[nodiscard]] virtual Timestamp now() = 0;
  virtual void sleep(std::chrono::milliseconds duration) = 0;

 protected:
  V4l2Kernel() = default;
  V4l2Kernel(const V4l2Kernel&) = default;
  V4l2Kernel& operator=(const V4l2Kernel&) = default;
};

}  // namespace marey::capture
