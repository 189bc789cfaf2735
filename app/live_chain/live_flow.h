// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "core/base/time.h"

namespace marey::app {

/// State of a live run: do its poses keep up with the cameras?
enum class Flow {
  kSteady,
  kBehind,   ///< Fewer than half of the pictures become poses.
  kStopped,  ///< No pose was computed for some time.
};

/// Detects that the poses of a live run do not keep up with its cameras. Uses a clock and
/// not the instants, because no further instant may come. Detects an overloaded computer
/// or cameras without pictures within a second. The caller supplies the time in every
/// call; times never decrease.
class LiveFlow {
 public:
  /// Window over which poses and pictures are counted. [s]
  static constexpr double kWindow_s = 0.8;
  /// The run has stopped after this time without a pose; longer for slow cameras. [s]
  static constexpr double kStopped_s = 0.5;
  /// Time allowed for the first pose, for the start of detectors and cameras. [s]
  static constexpr double kHeadStart_s = 2.0;

  /// Precondition: rate above 0.
  LiveFlow(FrameRate rate, Timestamp begin);

  /// Records that an instant was solved.
  void on_instant(Timestamp now);
  /// Updates and returns the flow. `pictures` is the maximum over the cameras of pictures
  /// so far, including those lost in transfer; it never decreases.
  Flow update(Timestamp now, long pictures);

  [[nodiscard]] Flow flow() const { return flow_; }
  /// Returns the message about the flow as of the last update(); empty while it is
  /// steady.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Returns the total time in which poses did not keep up. [s]
  [[nodiscard]] double troubled_s() const { return troubled_s_; }

 private:
  struct Sample {
    Timestamp time{0};
    long pictures = 0;
    long instants = 0;
  };
  [[nodiscard]] Flow flow_at(Timestamp now) const;
  void update_text(Timestamp now);

  double stopped_after_s_;
  std::deque<Sample> samples_;  ///< In the window, and the last one before it.
  Timestamp last_instant_;
  Timestamp last_look_;
  long instants_ = 0;
  Flow flow_ = Flow::kSteady;
  double troubled_s_ = 0.0;
  std::string text_;
};

}  // namespace marey::app
