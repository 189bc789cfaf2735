// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"

namespace marey {

/// The motion at another rate: a pose at every instant k / rate from the first to the
/// last of its frames, both included; no instant is lost or drifts, however long it is.
/// It has no poses when no such instant lies between them.
///
/// An instant that both rates share has its pose, bit for bit. Between frames, places go
/// in straight lines, and rotations the shorter way at a steady speed. Movement faster
/// than half the new rate is not smoothed away.
/// Linear in frames times joints.
/// Precondition: both rates above 0; every pose has one rotation per joint.
[[nodiscard]] Motion resample(const Motion& motion, FrameRate rate);

}  // namespace marey
