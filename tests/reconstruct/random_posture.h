// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reconstruct/posture.h"
#include "tests/support/random_bodies.h"

namespace marey::reconstruct {

/// Lengths of an average adult, each up to a tenth more or less.
[[nodiscard]] Lengths random_lengths(marey::testing::Dice& dice);

/// The body frame that goes with random_lengths().
[[nodiscard]] BodyFrame average_frame();
/// The same with hinges that are askew by up to 0.2 rad.
[[nodiscard]] BodyFrame askew_frame(marey::testing::Dice& dice);

/// A posture that a body could take: hips anywhere, trunk bent by up to half a radian per
/// joint, limbs anywhere, elbows and knees bent by 0.3 to 2.3 rad, every bone twisted.
/// Collar bones only swing: nothing shows their twist.
[[nodiscard]] Posture random_posture(marey::testing::Dice& dice);

}  // namespace marey::reconstruct
