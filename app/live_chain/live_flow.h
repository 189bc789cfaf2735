// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "core/base/time.h"

namespace marey::app {

/// Whether a live run's poses keep up with its cameras.
enum class Flow {
  kSteady,
  kBehind,   ///< Fewer than half of the pictures become poses.
  kStopped,  ///< No pose has come out for a while.
};

/// Judges a live run by a clock, not by its instants, which may never come: a computer
/// that is too busy, or cameras without pictures, show within a second. The clock is the
/// caller's: every call says what time it is, and times never decrease.
class LiveFlow {
 public:
  /// Fewer poses than pictures are judged over so long. [s]
  static constexpr double kWindow_s = 0.8;
  /// Without a pose for so long the run has stopped; longer where the cameras are slower.
  static constexpr double kStopped_s = 0.5;
  /// The first pose may take so long: detectors warm up, cameras start. [s]
  static constexpr double kHeadStart_s = 2.0;

  /// Precondition: rate above 0.
  LiveFlow(FrameRate rate, Timestamp begin);

  /// An instant was solved.
  void on_instant(Timestamp now);
  /// Judges. `pictures` is how many pictures the camera with the most has had so far,
  /// those that were lost on the way to us included; it never decreases.
  Flow look(Timestamp now, long pictures);

  [[nodiscard]] Flow flow() const { return flow_; }
  /// The message about the flow, as of the last look(); empty while it is steady.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// For how long poses have not kept up, in total. [s]
  [[nodiscard]] double troubled_s() const { return troubled_s_; }

 private:
  struct Sample {
    Timestamp time{0};
    long pictures = 0;
    long instants = 0;
  };
  [[nodiscard]] Flow judge(Timestamp now) const;
  void word(Timestamp now);

  double stopped_after_s_;
  std::deque<Sample> samples_;  ///< Of the window, and the last one before it.
  Timestamp last_instant_;
  Timestamp last_look_;
  long instants_ = 0;
  Flow flow_ = Flow::kSteady;
  double troubled_s_ = 0.0;
  std::string text_;
};

}  // namespace marey::app
