// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/timeline.h"

#include "core/base/frame_range.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/edit/edit_ops.h"
#include "core/skeleton.h"

namespace marey::edit {

/// Effect of an operation on each frame: 1 in its span, 0 beyond the fades before and
/// after, with continuous speed and acceleration between (core/base/smooth_step.h).
struct OpWeights {
  std::vector<double> weight;  ///< One per frame.
  FrameRange frames;           ///< Frames with a weight above 0.
};
/// Errors: resolve_span()'s.
[[nodiscard]] Result<OpWeights> op_weights(const Timeline& timeline, const EditOp& op);
[[nodiscard]] Result<OpWeights> op_weights(const EditState& state, const EditOp& op);

/// Returns the group of each joint. Joints without a bone belong to the group of their
/// parent; those between hips and trunk to the trunk, those above the hips to the root.
[[nodiscard]] std::vector<EditGroup> groups_of_joints(const Skeleton& skeleton);

/// Returns the joints of these groups, ascending; all joints if there are none.
[[nodiscard]] std::vector<JointIndex> joints_of_groups(const EditState& state,
                                                       std::span<const EditGroup> groups);

/// Mixes an operation's result into the motion before it: frames with weight 1 take the
/// new pose, frames with weight 0 keep the old one, both to the bit; between, the root is
/// interpolated linearly and rotations the shorter way. Joints of other groups keep their
/// rotation in their parent, and the root its place unless the root's group is included.
/// Precondition: both motions have the same skeleton and frames; one weight per frame.
void mix_motion(const Motion& before,
                const OpWeights& weights,
                const EditState& groups_of,
                std::span<const EditGroup> groups,
                Motion& after);

}  // namespace marey::edit
