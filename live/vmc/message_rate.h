// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace marey::live {

/// Detects more than `max_count` messages within one second. The caller supplies the
/// time.
class MessageRate {
 public:
  using Clock = std::chrono::steady_clock;

  explicit MessageRate(int max_count) : max_count_(max_count) {}

  /// Counts one message; returns false if it exceeds the limit. The first message starts
  /// a second; the first message after its end starts the next one.
  [[nodiscard]] bool allow(Clock::time_point now) {
    if (count_ == 0 || now - second_began_ >= std::chrono::seconds(1)) {
      second_began_ = now;
      count_ = 0;
    }
    return ++count_ <= max_count_;
  }

 private:
  int max_count_;
  int count_ = 0;
  Clock::time_point second_began_{};
};

}  // namespace marey::live
