// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"

// Private to marey::v4l2 and its tests.
namespace marey::capture {

/// The system calls that a camera needs, so that tests can put faults in their way. All
/// return a negative error number, such as -ENODEV, when they fail; none throws.
/// The system's own is stateless and may be used by any number of threads.
class V4l2Kernel {
 public:
  virtual ~V4l2Kernel() = default;

  /// Reading and writing, not blocking.
  [[nodiscard]] virtual int open(const std::string& path) = 0;
  virtual int close(int fd) = 0;
  /// Again where a signal interrupted it.
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// What there is of POLLIN, POLLERR and POLLHUP; 0 when nothing came in time.
  [[nodiscard]] virtual int poll(int fd, std::chrono::milliseconds timeout) = 0;
  /// nullptr when it fails.
  [[nodiscard]] virtual std::byte* map(int fd, std::size_t size, std::int64_t offset) = 0;
  virtual void unmap(std::byte* memory, std::size_t size) = 0;
  /// Of all video devices, by number: /dev/video2 comes before /dev/video10.
  [[nodiscard]] virtual std::vector<std::string> video_paths() = 0;
  /// CLOCK_MONOTONIC.
  [[nodiscard]] virtual Timestamp now() = 0;
  virtual void sleep(std::chrono::milliseconds duration) = 0;

 protected:
  V4l2Kernel() = default;
  V4l2Kernel(const V4l2Kernel&) = default;
  V4l2Kernel& operator=(const V4l2Kernel&) = default;
};

}  // namespace marey::capture
