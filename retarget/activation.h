// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"

namespace marey::retarget {

/// How far a constraint is active at `time_s`, from 0 to 1 (Kulpa 2005, 3.1.1.5, figure
/// 3.8).
///
/// Two quintic ramps (retarget/smooth_step.h), one up from the start and one down from
/// the stop, multiplied: the product of C2 functions is C2, so that a constraint which
/// stops before it was fully active turns round without a jerk, below 1. (Their minimum
/// would have a kink there.) Where the ramps do not overlap it is the figure's.
///
/// A duration of 0 is a step: active from the start on, that moment included, and not any
/// more from the stop on, so that of two constraints that hand over exactly one holds.
///
/// Precondition: finite; durations >= 0.
[[nodiscard]] double activation(const Activation& when, double time_s);

}  // namespace marey::retarget
