// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace marey::live {

/// The time that a sender on the network tells with its frames, on our clock. Theirs is
/// steadier than the moment of arrival, but it is anybody's number: they begin anew at 0,
/// jump, or tell nonsense.
class SenderClock {
 public:
  /// How far a sender's time may be from ours before it counts as one that began anew.
  static constexpr double kMaxOffset_s = 1.0;

  /// Of the frame that arrived at `arrived_s`, of a clock that does not go back, and said
  /// `sender_s`, or nothing. Within kMaxOffset_s of `arrived_s`, whatever was said. The
  /// first frame decides, for all of them, whether the sender's time is looked at.
  /// Precondition: both are finite.
  [[nodiscard]] double at_s(std::optional<double> sender_s, double arrived_s);

 private:
  std::optional<bool> has_sender_time_;  ///< Whether the first frame said its time.
  double ours_from_theirs_s_ = 0.0;
  double ahead_s_ = 0.0;  ///< The last frame's time, of its arrival.
};

}  // namespace marey::live
