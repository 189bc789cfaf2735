// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_flow.h"

#include <algorithm>
#include <cstdio>

#include "core/base/assert.h"

namespace marey::app {
namespace {

// Shares of the pictures that become poses. Two limits give hysteresis.
constexpr double kBehindBelow = 0.45;
constexpr double kSteadyFrom = 0.6;
// Minimum number of pictures for a decision.
constexpr long kMinPictures = 4;
// A stop must be reported within one second, and the caller checks every 0.1 s.
constexpr double kMaxWait_s = 0.85;
constexpr double kPeriods = 4.0;

}  // namespace

LiveFlow::LiveFlow(FrameRate rate, Timestamp begin)
    : stopped_after_s_(std::clamp(kPeriods / rate.hz, kStopped_s, kMaxWait_s)),
      last_instant_(begin),
      last_look_(begin) {
  MAREY_ASSERT(rate.hz > 0.0);
  samples_.push_back({begin, 0, 0});
}

void LiveFlow::on_instant(Timestamp now) {
  ++instants_;
  last_instant_ = now;
}

Flow LiveFlow::flow_at(Timestamp now) const {
  const double allowed_s = instants_ == 0 ? kHeadStart_s : stopped_after_s_;
  if (seconds(now - last_instant_) > allowed_s) return Flow::kStopped;
  if (instants_ == 0) return Flow::kSteady;
  const Sample& first = samples_.front();
  const long pictures = samples_.back().pictures - first.pictures;
  const auto instants = static_cast<double>(samples_.back().instants - first.instants);
  if (pictures < kMinPictures) {
    // A stopped run becomes steady only after it keeps up again.
    return flow_ == Flow::kSteady ? Flow::kSteady : Flow::kBehind;
  }
  const double needed = flow_ == Flow::kSteady ? kBehindBelow : kSteadyFrom;
  return instants < needed * static_cast<double>(pictures) ? Flow::kBehind
                                                           : Flow::kSteady;
}

void LiveFlow::update_text(Timestamp now) {
  text_.clear();
  if (flow_ == Flow::kSteady) return;
  char head[160];
  if (flow_ == Flow::kStopped) {
    std::snprintf(head,
                  sizeof head,
                  "no new pose for %.1f s: cameras send no pictures, or the computer is "
                  "too busy to search them",
                  seconds(now - last_instant_));
  } else {
    std::snprintf(head,
                  sizeof head,
                  "poses fall behind: %ld from the last %ld pictures of a camera; the "
                  "computer is too slow or too busy",
                  samples_.back().instants - samples_.front().instants,
                  samples_.back().pictures - samples_.front().pictures);
  }
  text_ = std::string(head) +
          ". Next: close other programs, use fewer cameras or a lower frame rate, and "
          "check that every camera streams.";
}

Flow LiveFlow::update(Timestamp now, long pictures) {
  if (flow_ != Flow::kSteady) troubled_s_ += seconds(now - last_look_);
  last_look_ = now;
  samples_.push_back({now, pictures, instants_});
  while (samples_.size() > 2 && seconds(now - samples_[1].time) >= kWindow_s) {
    samples_.pop_front();
  }
  flow_ = flow_at(now);
  update_text(now);
  return flow_;
}

}  // namespace marey::app
