// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

/// Weights of blended postures that are computed in double precision, one lane at a time.
/// They are compiled once, without the instructions of any kernel.
namespace marey::retarget {

/// Computes the share by which each joint of a mean posture is clamped to its limits:
/// completely where every blended posture is within the limits to single precision, and
/// not at all where one of them exceeds them by a degree or two. In: the largest angle
/// beyond the limits [rad]. Out: the share, 0 to 1.
void limit_shares(std::span<float> angles);

/// Computes the share by which the centre of mass of a mean posture is corrected. In: its
/// error [units]. Out: the share, 0 to 1. `precisions`: those of balance [units].
void settle_shares(std::span<float> errors, std::span<const float> precisions);

}  // namespace marey::retarget
