// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/activation.h"

#include <optional>

#include "retarget/smooth_step.h"

namespace marey::retarget {
namespace {

/// 0 before `begin_s`, 1 from `begin_s + duration_s` on.
double ramp(double begin_s, double duration_s, double time_s) {
  if (time_s < begin_s) return 0.0;
  // Also of a duration that the time's last digit does not show.
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

}  // namespace marey::retarget
