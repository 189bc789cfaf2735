// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/frame_queue.h"

#include <algorithm>

#include "core/base/assert.h"

namespace marey::app {

// for_overwrite: memory that was not written to uses no pages.
FrameQueue::FrameQueue(std::size_t places, std::size_t max_bytes)
    : memory_(std::make_unique_for_overwrite<std::byte[]>(max_bytes)),
      size_(max_bytes),
      ring_(places) {
  MAREY_ASSERT(places > 0 && max_bytes > 0);
}

/// Returns the offset of free memory for a frame of `bytes` in one piece: after the
/// newest frame, or at the beginning if that is free. nullopt if there is none.
std::optional<std::size_t> FrameQueue::room_for(std::size_t bytes) const {
  if (count_ == 0) return bytes <= size_ ? std::optional<std::size_t>(0) : std::nullopt;
  const auto begin = static_cast<std::size_t>(ring_[first_].bytes.data() - memory_.get());
  if (end_ > begin) {
    if (size_ - end_ >= bytes) return end_;
    return begin >= bytes ? std::optional<std::size_t>(0) : std::nullopt;
  }
  return begin - end_ >= bytes ? std::optional(end_) : std::nullopt;
}

bool FrameQueue::push(std::span<const std::byte> bytes,
                      const recordings::TakeFrame& stamp) {
  MAREY_ASSERT(!bytes.empty());
  {
    const std::lock_guard lock(mutex_);
    MAREY_ASSERT(!closed_);
    const auto at = room_for(bytes.size());
    if (!at || count_ == ring_.size()) return false;
    std::byte* const place = memory_.get() + *at;
    std::copy(bytes.begin(), bytes.end(), place);
    ring_[(first_ + count_) % ring_.size()] = {{place, bytes.size()}, stamp};
    end_ = *at + bytes.size();
    ++count_;
  }
  changed_.notify_one();
  return true;
}

void FrameQueue::take_back() {
  if (!in_use_) return;
  first_ = (first_ + 1) % ring_.size();
  --count_;
  in_use_ = false;
}

const QueuedFrame* FrameQueue::pop(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  take_back();
  changed_.wait_for(lock, timeout, [this] { return count_ > 0 || closed_; });
  if (count_ == 0) return nullptr;
  in_use_ = true;
  return &ring_[first_];
}

bool FrameQueue::is_over() {
  const std::lock_guard lock(mutex_);
  return closed_ && count_ == (in_use_ ? 1 : 0);
}

void FrameQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace marey::app
