// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "recordings/takes/take_file.h"

namespace marey::app {

struct QueuedFrame {
  std::span<const std::byte> bytes;
  recordings::TakeFrame stamp;
};

/// Frames on their way from one thread to another, in one piece of memory of a fixed
/// size. Of that, the system gives only as much as was ever in use at once: while the
/// reader keeps up, a frame or two. Allocates nothing after it was made.
class FrameQueue {
 public:
  /// For up to `places` frames that have up to `max_bytes` together.
  /// Precondition: neither is 0.
  FrameQueue(std::size_t places, std::size_t max_bytes);

  /// Copies a frame in. False when there is no room: the frame is not taken.
  /// Precondition: it has bytes, and the queue is not closed.
  [[nodiscard]] bool push(std::span<const std::byte> bytes,
                          const recordings::TakeFrame& stamp);
  /// The oldest frame, valid until the next call. Null when none came within `timeout`,
  /// or none will come any more: is_over().
  [[nodiscard]] const QueuedFrame* pop(std::chrono::milliseconds timeout);
  /// Closed, and every frame was handed out.
  [[nodiscard]] bool is_over();
  /// No more frames will come.
  void close();

 private:
  [[nodiscard]] std::optional<std::size_t> room_for(std::size_t bytes) const;
  void take_back();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<std::byte[]> memory_;
  const std::size_t size_;
  std::vector<QueuedFrame> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;  ///< With the one that is lent.
  std::size_t end_ = 0;    ///< Of the newest frame, in the memory.
  bool lent_ = false;      ///< The first was handed out.
  bool closed_ = false;
};

}  // namespace marey::app
