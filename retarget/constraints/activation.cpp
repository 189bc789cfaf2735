// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/activation.h"

#include <algorithm>
#include <optional>

#include "core/base/smooth_step.h"

namespace marey::retarget {
namespace {

/// Returns 0 before `begin_s`, 1 from `begin_s + duration_s` on.
double ramp(double begin_s, double duration_s, double time_s) {
  if (time_s < begin_s) return 0.0;
  // Also for durations below the resolution of the time.
  if (time_s - begin_s >= duration_s) return 1.0;
  return smooth_step((time_s - begin_s) / duration_s);
}

}  // namespace

double activation(const Activation& when, double time_s) {
  double active = 1.0;
  if (when.start_s) active *= ramp(*when.start_s, when.start_duration_s, time_s);
  if (when.stop_s) active *= 1.0 - ramp(*when.stop_s, when.stop_duration_s, time_s);
  return active;
}

LiveActivation::LiveActivation(const Activation& planned)
    : was_active_(!planned.start_s),
      start_duration_s_(planned.start_duration_s),
      stop_duration_s_(planned.stop_duration_s) {
  if (planned.start_s) start(*planned.start_s);
  if (planned.stop_s) stop(*planned.stop_s);
}

void LiveActivation::start(double time_s) {
  change({time_s, true});
}

void LiveActivation::stop(double time_s) {
  change({time_s, false});
}

void LiveActivation::change(const Change& wanted) {
  while (count_ > 0 && changes_[count_ - 1].time_s > wanted.time_s) --count_;
  const bool is_active = count_ > 0 ? changes_[count_ - 1].starts : was_active_;
  if (is_active == wanted.starts) return;
  if (count_ == changes_.size()) {
    was_active_ = changes_[0].starts;
    std::move(changes_.begin() + 1, changes_.end(), changes_.begin());
    --count_;
  }
  changes_[count_++] = wanted;
}

double LiveActivation::ramp_of(const Change& change, double time_s) const {
  return ramp(
      change.time_s, change.starts ? start_duration_s_ : stop_duration_s_, time_s);
}

double LiveActivation::at(double time_s) const {
  double active = was_active_ ? 1.0 : 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double left = 1.0 - ramp_of(changes_[i], time_s);
    active = changes_[i].starts ? 1.0 - (1.0 - active) * left : active * left;
  }
  return share_ * active;
}

}  // namespace marey::retarget
