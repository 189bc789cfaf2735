// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"

namespace marey::app {

/// Returns the peak acceleration of a joint with a bone, by second differences of its
/// place in the world. [m/s^2] Linear in frames times joints.
[[nodiscard]] double peak_acceleration_m_per_s2(const Motion& motion);

}  // namespace marey::app
