// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/follow_com.h"

#include <algorithm>

#include "core/base/assert.h"
#include "retarget/com/close_com_over_feet.h"

namespace marey::retarget {
namespace {

// A leg that is too short by less is not reported. [m]
constexpr double kShortLeg_m = 1e-7;

void note_worst(double value, int frame, double& worst, int& worst_frame) {
  if (value <= worst) return;
  worst = value;
  worst_frame = frame;
}

}  // namespace

FollowComReport follow_com(const ComFollower& body,
                           const ComPlan& plan,
                           std::span<Pose> out) {
  const std::size_t count = plan.reference.size();
  MAREY_ASSERT(plan.com_in_world.size() == count && out.size() == count);
  MAREY_ASSERT(plan.feet[0].size() == count && plan.feet[1].size() == count);
  FollowComReport report;
  ComCloser closer(body);
  for (std::size_t t = 0; t < count; ++t) {
    const std::array<FootGoal, 2> feet{plan.feet[0][t], plan.feet[1][t]};
    const ClosedFrame frame =
        closer.close(plan.reference[t], plan.com_in_world[t], feet, out[t]);
    const int at = static_cast<int>(t);
    note_worst(frame.com_error_m, at, report.worst_com_m, report.worst_com_frame);
    note_worst(frame.foot_error_m, at, report.worst_foot_m, report.worst_foot_frame);
    if (feet[0].hold <= 0.0 && feet[1].hold <= 0.0) {
      report.worst_flight_com_m = std::max(report.worst_flight_com_m, frame.com_error_m);
    }
    report.raised_heel_m = std::max(report.raised_heel_m, frame.raised_heel_m);
    if (frame.short_leg_m < kShortLeg_m) continue;
    ++report.short_leg_frames;
    note_worst(frame.short_leg_m, at, report.short_leg_m, report.short_leg_frame);
  }
  return report;
}

}  // namespace marey::retarget
