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

/// What pages said and nobody has looked at yet: a bounded queue between two threads, the
/// oldest giving way.
class TextInbox {
 public:
  explicit TextInbox(std::size_t max_count) : max_count_(max_count) {}

  void put(ClientId client, std::string_view text);
  /// All of it, oldest first; `out` is emptied before.
  void take(std::vector<ReceivedText>& out);
  /// Until there is a text, the time is over or close(); whether there is one.
  bool wait(std::chrono::milliseconds longest);
  /// Nobody waits any more.
  void close();
  /// Texts that gave way.
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
