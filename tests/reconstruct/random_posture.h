// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reconstruct/posture/posture.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::reconstruct {

/// Returns lengths of an average adult, each changed by up to a tenth.
[[nodiscard]] Lengths random_lengths(marey::testing::Dice& dice);

/// Returns the body frame for random_lengths().
[[nodiscard]] BodyConstants average_frame();
/// Returns the same with hinges tilted by up to 0.2 rad.
[[nodiscard]] BodyConstants askew_frame(marey::testing::Dice& dice);

/// Returns a posture that a body could take: hips anywhere, trunk bent by up to half a
/// radian per joint, limbs anywhere, elbows and knees bent by 0.3 to 2.3 rad, every bone
/// twisted. Collar bones have no twist, since nothing measures it.
[[nodiscard]] Posture random_posture(marey::testing::Dice& dice);

}  // namespace marey::reconstruct
