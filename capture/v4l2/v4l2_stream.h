// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/v4l2/device_types.h"
#include "capture/v4l2/v4l2_errors.h"
#include "capture/v4l2/v4l2_kernel.h"
#include "core/base/result.h"

struct v4l2_buffer;

// Private to marey::v4l2.
namespace marey::capture {

/// Returns the number of lost frames between two sequence numbers of a driver, which wrap
/// after 2^32. Returns 0 if they repeat or decrease: the driver then restarted.
[[nodiscard]] int frames_between(std::uint32_t before, std::uint32_t after);

/// The buffers of an open device whose format is set, and the frames in them.
class V4l2Stream {
 public:
  /// Requests, maps and queues about `buffers` buffers and starts the stream. `kernel`
  /// and `fd`, which it does not own, must outlive it. Errors (kDevice): the kernel
  /// refused one of these steps.
  [[nodiscard]] static Result<V4l2Stream> start(V4l2Kernel& kernel,
                                                int fd,
                                                const std::string& path,
                                                const DeviceSettings& settings,
                                                int buffers);

  V4l2Stream(V4l2Stream&&) noexcept;
  V4l2Stream& operator=(V4l2Stream&&) = delete;
  ~V4l2Stream();

  /// See V4l2Device::next().
  [[nodiscard]] Result<std::optional<RawFrame>> next(std::chrono::milliseconds timeout);

  [[nodiscard]] int buffers() const { return static_cast<int>(buffers_.size()); }
  [[nodiscard]] bool monotonic_clock() const { return monotonic_clock_; }

 private:
  struct Buffer {
    std::span<std::byte> memory;
    bool queued = false;  ///< Owned by the driver.
  };

  V4l2Stream(V4l2Kernel& kernel,
             int fd,
             std::string path,
             const DeviceSettings& settings);
  [[nodiscard]] Status map_buffers(int count);
  /// Queues all buffers that the driver does not have. Returns the last errno, or 0.
  int queue_buffers();
  /// Returns nullopt if there is no frame yet.
  [[nodiscard]] Result<std::optional<RawFrame>> take();
  [[nodiscard]] RawFrame frame_in(const v4l2_buffer& buffer);
  [[nodiscard]] bool is_stale(const RawFrame& frame) const;
  [[nodiscard]] Error error(V4l2Step step, int refused) const;

  V4l2Kernel* kernel_;
  int fd_;
  std::string path_;
  PixelFormat format_;
  std::size_t min_bytes_ = 1;  ///< Size of a complete image.
  std::vector<Buffer> buffers_;
  Timestamp started_{0};
  int stale_to_skip_ = 0;  ///< Number of buffers that may still be from before the start.
  std::optional<std::uint32_t> last_sequence_;
  bool monotonic_clock_ = false;
  bool streaming_ = false;
};

}  // namespace marey::capture
