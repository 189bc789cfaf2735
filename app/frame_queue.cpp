// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/frame_queue.h"

#include "core/assert.h"

namespace marey::app {

FrameQueue::FrameQueue(std::size_t places) : ring_(places) {
  MAREY_ASSERT(places > 0);
}

bool FrameQueue::push(std::span<const std::byte> bytes,
                      const recordings::TakeFrame& stamp) {
  {
    const std::lock_guard lock(mutex_);
    MAREY_ASSERT(!closed_);
    if (count_ == ring_.size()) return false;
    QueuedFrame& place = ring_[(first_ + count_) % ring_.size()];
    place.bytes.assign(bytes.begin(), bytes.end());
    place.stamp = stamp;
    ++count_;
  }
  changed_.notify_one();
  return true;
}

const QueuedFrame* FrameQueue::pop() {
  std::unique_lock lock(mutex_);
  if (lent_) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
    lent_ = false;
  }
  changed_.wait(lock, [this] { return count_ > 0 || closed_; });
  if (count_ == 0) return nullptr;
  lent_ = true;
  return &ring_[first_];
}

void FrameQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace marey::app
