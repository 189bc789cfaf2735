// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace marey::live {

/// Converts the time that a network sender adds to its frames to the receiver's clock.
/// The sender's time has less jitter than the time of arrival, but it is not reliable: it
/// may restart at 0, jump, or be arbitrary.
class SenderClock {
 public:
  /// Maximum difference of sender and receiver time; above it the sender's clock counts
  /// as restarted.
  static constexpr double kMaxOffset_s = 1.0;

  /// Returns the time of the frame that arrived at `arrived_s` (a monotonic clock) with
  /// the sender's time `sender_s`, if it has one. The result is within kMaxOffset_s of
  /// `arrived_s` for any input. The first frame decides for all frames whether the
  /// sender's time is used. Precondition: both are finite.
  [[nodiscard]] double at_s(std::optional<double> sender_s, double arrived_s);

 private:
  std::optional<bool> has_sender_time_;  ///< True if the first frame had a sender time.
  double ours_from_theirs_s_ = 0.0;
  double ahead_s_ = 0.0;  ///< Time of the last frame minus the time of its arrival.
};

}  // namespace marey::live
