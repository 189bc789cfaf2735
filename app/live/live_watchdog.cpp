// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_watchdog.h"

namespace marey::app {

LiveWatchdog::LiveWatchdog(FrameRate rate,
                           Timestamp begin,
                           LiveOutputs& outputs,
                           Console& console)
    : flow_(rate, begin), outputs_(outputs), console_(console) {}

void LiveWatchdog::on_instant(Timestamp now, bool was_sent) {
  flow_.on_instant(now);
  if (was_sent) last_packet_ = now;
}

void LiveWatchdog::report(Timestamp now) {
  if (is_behind()) {
    last_trouble_ = now;
    if (!has_warned_) console_.warn(flow_.text());
    has_warned_ = true;
  } else if (has_warned_ && seconds(now - last_trouble_) >= kOver_s) {
    console_.say("poses keep up with the cameras again");
    has_warned_ = false;
  }
}

bool LiveWatchdog::update(Timestamp now, long pictures) {
  const Flow before = flow_.flow();
  const Flow flow = flow_.update(now, pictures);
  const bool has_changed = flow != before;
  report(now);
  if (flow == Flow::kSteady || !last_packet_) return has_changed;
  if (has_changed || seconds(now - *last_packet_) >= kRepeat_s) {
    outputs_.send_not_tracking();
    last_packet_ = now;
  }
  return has_changed;
}

}  // namespace marey::app
