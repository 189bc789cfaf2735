// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/live_chain/live_flow.h"
#include "app/live_chain/live_outputs.h"
#include "app/shell/console.h"

namespace marey::app {

/// Tells the console and the receivers of VMC when poses do not keep up with the cameras.
/// Receivers are told between instants, too, which may not come. The clock is the
/// caller's.
class LiveWatchdog {
 public:
  /// While there is trouble receivers are told this often: UDP loses packets. [s]
  static constexpr double kRepeat_s = 0.25;
  /// Trouble that comes back before so long is the same to the console. [s]
  static constexpr double kOver_s = 3.0;

  /// `outputs` and `console` outlive it. Precondition: rate above 0.
  LiveWatchdog(FrameRate rate, Timestamp begin, LiveOutputs& outputs, Console& console);

  /// An instant was solved, and its packets were sent or there are none.
  void on_instant(Timestamp now, bool was_sent);
  /// See LiveFlow::look(). True when the flow is another than before.
  bool look(Timestamp now, long pictures);

  [[nodiscard]] const LiveFlow& flow() const { return flow_; }
  [[nodiscard]] bool is_behind() const { return flow_.flow() != Flow::kSteady; }

 private:
  void tell(Timestamp now);

  LiveFlow flow_;
  LiveOutputs& outputs_;
  Console& console_;
  std::optional<Timestamp> last_packet_;  ///< nullopt: receivers know of no pose.
  Timestamp last_trouble_{0};
  bool has_warned_ = false;  ///< The console knows of trouble.
};

}  // namespace marey::app
