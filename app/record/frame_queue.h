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

/// Queue of frames between two threads, in one block of memory of fixed size. The system
/// provides only as much memory as was in use at once: a frame or two while the reader
/// keeps up. Allocates only in the constructor.
class FrameQueue {
 public:
  /// Creates a queue for up to `places` frames with up to `max_bytes` together.
  /// Precondition: neither is 0.
  FrameQueue(std::size_t places, std::size_t max_bytes);

  /// Copies a frame into the queue. Returns false if there is no room; the frame is not
  /// queued then. Preconditions: the frame has bytes, and the queue is not closed.
  [[nodiscard]] bool push(std::span<const std::byte> bytes,
                          const recordings::TakeFrame& stamp);
  /// Returns the oldest frame, valid until the next call. Null if none came within
  /// `timeout`, or if is_over().
  [[nodiscard]] const QueuedFrame* pop(std::chrono::milliseconds timeout);
  /// Returns true if the queue is closed and every frame was returned.
  [[nodiscard]] bool is_over();
  /// Closes the queue: no more frames will come.
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
  std::size_t count_ = 0;  ///< Includes the frame that pop() returned.
  std::size_t end_ = 0;    ///< End of the newest frame in the memory.
  bool in_use_ = false;    ///< pop() returned the first frame.
  bool closed_ = false;
};

}  // namespace marey::app
