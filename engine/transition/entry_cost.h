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
/// "Inertialization transition cost"), in the heading frame, on an average body of this
/// rig's proportions. +infinity where the supports are left against right.
/// `half_life_s` > 0.
[[nodiscard]] double entry_cost(const Rig& rig,
                                const BlendPosture& from,
                                const PostureRates& from_rates,
                                const BlendPosture& to,
                                const PostureRates& to_rates,
                                double half_life_s = 0.1);

/// Returns the time in a clip, within `entry_s` of `at_s` (anywhere in a clip that loops
/// if `anywhere`), of least entry_cost(); frames whose supports are left against right of
/// `bearing` (bits by ClipFootPart) are left out unless there are no others.
[[nodiscard]] double best_entry_s(const Rig& rig,
                                  const BlendPosture& from,
                                  const PostureRates& from_rates,
                                  unsigned bearing,
                                  const MotionClip& clip,
                                  double at_s,
                                  double entry_s,
                                  bool anywhere);

}  // namespace marey::engine
