// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string_view>
#include <vector>

#include "live/web/received_text.h"

namespace marey::live {

/// Texts received from pages and not taken yet: a bounded queue between two threads that
/// drops the oldest texts.
class TextInbox {
 public:
  explicit TextInbox(std::size_t max_count) : max_count_(max_count) {}

  void put(ClientId client, std::string_view text);
  /// Moves all texts to `out`, oldest first; `out` is emptied before.
  void take(std::vector<ReceivedText>& out);
  /// Blocks until there is a text, `longest` has passed, or close() is called; returns
  /// true if there is a text.
  bool wait(std::chrono::milliseconds longest);
  /// Ends all waits, now and later.
  void close();
  /// Returns the number of dropped texts.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  const std::size_t max_count_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::deque<ReceivedText> texts_;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace marey::live
