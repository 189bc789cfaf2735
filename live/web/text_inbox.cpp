// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/text_inbox.h"

#include <iterator>

namespace marey::live {

void TextInbox::put(ClientId client, std::string_view text) {
  {
    const std::lock_guard lock(mutex_);
    if (texts_.size() == max_count_) {
      texts_.pop_front();
      ++dropped_;
    }
    texts_.push_back({client, std::string(text)});
  }
  came_.notify_one();
}

void TextInbox::take(std::vector<ReceivedText>& out) {
  out.clear();
  const std::lock_guard lock(mutex_);
  out.assign(std::move_iterator(texts_.begin()), std::move_iterator(texts_.end()));
  texts_.clear();
}

bool TextInbox::wait(std::chrono::milliseconds longest) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, longest, [this] { return closed_ || !texts_.empty(); });
  return !texts_.empty();
}

void TextInbox::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  came_.notify_all();
}

std::uint64_t TextInbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace marey::live
