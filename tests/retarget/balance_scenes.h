// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character_spec.h"
#include "core/motion.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// An average adult at 60 Hz that goes over its left foot, raises the straight right leg
/// in front of it to the height of its hips while its trunk leans back, holds that for a
/// second, and comes back: 4 s. The left foot does not move.
[[nodiscard]] Motion slow_kick();
/// Both feet stand; the trunk bends forward by 80 degrees while the hips go back, for a
/// second: 4 s.
[[nodiscard]] Motion deep_bend();
/// Feet stand, then both leave the floor together by `high_m`, on a parabola, and land.
[[nodiscard]] Motion small_jump(double high_m);

/// Frames of these scenes in which the posture is held.
inline constexpr int kPostureFirst = 90;
inline constexpr int kPostureLast = 150;

/// That adult with a trunk, and all it carries, `factor` times as far above the hips.
[[nodiscard]] Skeleton with_trunk(double factor);
/// 70 kg, and the trunk `factor` times as heavy as then.
[[nodiscard]] MassSpec with_trunk_mass(double factor);

}  // namespace marey::retarget
