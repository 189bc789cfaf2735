// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"

namespace marey {

/// Returns the motion at another rate: a pose at every instant k / rate from the first to
/// the last of its frames, both included. No instant is lost or drifts, for any length.
/// There are no poses if no such instant lies between them.
///
/// At an instant that both rates share, the pose is bit-identical. Between frames,
/// positions are interpolated linearly, and rotations the shorter way at constant angular
/// speed. Movement faster than half the new rate is not smoothed (no low-pass filter).
/// Linear in frames times joints.
/// Precondition: both rates above 0; every pose has one rotation per joint.
[[nodiscard]] Motion resample(const Motion& motion, FrameRate rate);

}  // namespace marey
