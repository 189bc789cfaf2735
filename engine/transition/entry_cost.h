// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clips/motion_base.h"
#include "engine/clips/rig.h"
#include "engine/transition/inertial_offset.h"

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// Returns the cost of an inertial transition [m s]: the sum over feet, hips, hands and
/// head of the area under the decaying offset, |2 x / y + v / y^2| (Holden 2022,
/// "Inertialization transition cost"), y = 2 ln 2 / half-life, in the heading frame, on
/// the rig's body. That is the integral of |offset| where the offset does not change its
/// direction. +infinity where the supports (bits by ClipFootPart; 0: unknown or none) are
/// left alone against right alone. `half_life_s` > 0.
[[nodiscard]] double entry_cost(const Rig& rig,
                                const BlendPosture& from,
                                const PostureRates& from_rates,
                                const BlendPosture& to,
                                const PostureRates& to_rates,
                                double half_life_s = 0.1,
                                unsigned from_bearing = 0,
                                unsigned to_bearing = 0);

/// Returns the time of the frame in a clip, within `entry_s` of `at_s` (anywhere in a
/// clip that loops if `anywhere`), of least entry_cost(); frames whose supports are left
/// against right of `bearing` (bits by ClipFootPart) are left out unless there are no
/// others. Rates of a frame are those between its neighbours. The earliest of equal ones.
/// Without a frame in that time, `at_s` clamped to the clip. Some microseconds per frame;
/// allocates nothing.
[[nodiscard]] double best_entry_s(const Rig& rig,
                                  const BlendPosture& from,
                                  const PostureRates& from_rates,
                                  unsigned bearing,
                                  const MotionClip& clip,
                                  double at_s,
                                  double entry_s,
                                  bool anywhere);

}  // namespace marey::engine
