// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"
#include "recordings/motion/npz.h"

namespace marey::app {

/// Returns the foot contacts of a motion, detected by retarget::detect_contacts(). On
/// marey's own skeleton they agree with dynamics::find_flights(): no foot bears during
/// a flight, and take-off and landing are set for the feet in contact just before and
/// after. Names are leftFoot, leftToes, rightFoot and rightToes; each means that the
/// ankle or toe joint rests. Empty if the body's bones do not allow detection. Linear in
/// frames.
[[nodiscard]] recordings::NpzContacts foot_contacts(const Motion& motion);

}  // namespace marey::app
