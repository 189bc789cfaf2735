// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/models/hand_motion.h"
#include "engine/models/quintic_leg.h"
#include "engine/models/reach_target.h"

namespace marey::engine {

/// State of a displacement and the arrival that is wanted.
struct ArrivalQuestion {
  double start_s = 0.0;  ///< Time of the state.
  Motion3 moved_m;       ///< Displacement of the clip's hand.
  Motion3 turned_rad;
  HandMotion clip_at_arrival;  ///< While the clip keeps its current rate.
  double arrive_s = 0.0;       ///< > start_s.
  /// Latest time to which the clip's event can be put off.
  double latest_s = 0.0;
  ReachTarget target;
  double target_time_s = 0.0;  ///< For the target.
};

/// Legs of the displacement to the arrival; both end at the same time.
struct ArrivalPlan {
  QuinticLeg move_m;
  QuinticLeg turn_rad;
  [[nodiscard]] double arrive_s() const { return move_m.end_s(); }
};

/// Plans the displacement so that the hand meets the predicted target with the wanted
/// velocity relative to it and without acceleration. The arrival is put off while
/// the displacement accelerates by more than the limits in `options`, or its ends demand.
/// A clip that is slowed for that arrives with less speed.
[[nodiscard]] ArrivalPlan plan_arrival(const ArrivalQuestion& question,
                                       const ReachOptions& options);

/// Returns a leg to zero in `min_length_s`, or in the time that the limit needs.
[[nodiscard]] QuinticLeg fade_leg(double start_s,
                                  double min_length_s,
                                  const Motion3& from,
                                  double max_acceleration);

}  // namespace marey::engine
