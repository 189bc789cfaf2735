// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/frame_range.h"
#include "core/humanoid.h"
#include "core/motion.h"

namespace marey::edit {

/// Largest acceleration of a bone's joint, as a second difference.
struct PeakAcceleration {
  double m_per_s2 = 0.0;
  HumanBone bone = HumanBone::kHips;
  int frame = 0;  ///< The middle one of the three.
};

/// Returns the peak over the given frames, as far as they have a frame before and after;
/// 0 if none has. Joints without a bone do not count. Linear in these frames times
/// joints.
[[nodiscard]] PeakAcceleration peak_acceleration(const Motion& motion,
                                                 const FrameRange& frames);
/// Returns the peak over the whole motion.
[[nodiscard]] PeakAcceleration peak_acceleration(const Motion& motion);

}  // namespace marey::edit
