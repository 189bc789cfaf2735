// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/live_chain/live_flow.h"
#include "app/live_chain/live_outputs.h"
#include "app/shell/console.h"

namespace marey::app {

/// Warns the console and the receivers of VMC when poses do not keep up with the cameras.
/// Receivers are also notified between instants, because no further instant may come. The
/// caller supplies the time.
class LiveWatchdog {
 public:
  /// Interval between notifications of receivers while poses fall behind; repeated
  /// because UDP loses packets. [s]
  static constexpr double kRepeat_s = 0.25;
  /// Trouble that recurs within this time causes no second console warning. [s]
  static constexpr double kOver_s = 3.0;

  /// `outputs` and `console` must outlive the object. Precondition: rate above 0.
  LiveWatchdog(FrameRate rate, Timestamp begin, LiveOutputs& outputs, Console& console);

  /// Records that an instant was solved; `was_sent`: its packets were sent.
  void on_instant(Timestamp now, bool was_sent);
  /// Calls LiveFlow::update(). Returns true if the flow has changed.
  bool update(Timestamp now, long pictures);

  [[nodiscard]] const LiveFlow& flow() const { return flow_; }
  [[nodiscard]] bool is_behind() const { return flow_.flow() != Flow::kSteady; }

 private:
  void report(Timestamp now);

  LiveFlow flow_;
  LiveOutputs& outputs_;
  Console& console_;
  std::optional<Timestamp> last_packet_;  ///< nullopt: no pose was sent yet.
  Timestamp last_trouble_{0};
  bool has_warned_ = false;  ///< The console was warned.
};

}  // namespace marey::app
