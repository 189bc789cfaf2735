// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"
#include "recordings/motion/npz.h"

namespace marey::app {

/// When feet bear in a motion, by retarget::detect_contacts(); of marey's own skeleton in
/// agreement with reconstruct::find_flights(): no foot bears in a flight, and its
/// take-off and landing are those of the feet next to it. Names are leftFoot,
/// leftToes, rightFoot and rightToes, an ankle or a toe joint that rests. Nothing when
/// the body's bones do not let it be told. Linear in frames.
[[nodiscard]] recordings::NpzContacts foot_contacts(const Motion& motion);

}  // namespace marey::app
