// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "recordings/take_file.h"

namespace marey::app {

struct QueuedFrame {
  std::vector<std::byte> bytes;
  recordings::TakeFrame stamp;
};

/// Frames on their way from one thread to another. It never grows: once each of its
/// places has held a frame of the largest size, nothing is allocated.
class FrameQueue {
 public:
  /// Precondition: at least one place.
  explicit FrameQueue(std::size_t places);

  /// Copies a frame in. False when there is no place: the frame is not taken.
  [[nodiscard]] bool push(std::span<const std::byte> bytes,
                          const recordings::TakeFrame& stamp);
  /// The oldest frame, valid until the next call; waits for one. Null when the queue was
  /// closed and is empty.
  [[nodiscard]] const QueuedFrame* pop();
  /// No more frames will come.
  void close();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<QueuedFrame> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;  ///< With the one that is lent.
  bool lent_ = false;      ///< The first was handed out.
  bool closed_ = false;
};

}  // namespace marey::app
