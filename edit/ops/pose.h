// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Sets a key: displaces a bone at an instant, with a smooth displacement around it
/// (displacement map; Witkin & Popovic 1995, "Motion warping").
///
/// The share of the displacement is smooth_step(1 - |t - at| / width_s), 1 at the
/// instant and 0 from width_s on, with continuous speed and acceleration. Frames outside
/// keep their pose to the bit. Joints and feet are displaced by displace_bone().
///
/// Each key is an operation of its own, relative to the motion that it receives, so
/// displacements add up. Keys that are width_s apart have no effect at each other's
/// instants: between them their shares add up to 1, so the displacement goes from the
/// first key to the second by a C2 curve without leaving the interval between them. A
/// series of such keys of the same bone is thus a spline through the keys (for rotations:
/// exactly if their axes agree). Keys that are nearer influence each other.
///
/// Errors (bad input): an instant beyond the motion; width_s that is not positive or that
/// contains no frame; span, groups or blend_s; those of displace_bone().
[[nodiscard]] Result<EditState> apply_pose(const PoseOp& op,
                                           const OpContext& context,
                                           const EditState& state,
                                           OpReport& report);

}  // namespace marey::edit
