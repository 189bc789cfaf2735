// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"
#include "core/pose.h"

namespace marey::edit {

/// Returns the pose between two: the root linearly, rotations the shorter way at constant
/// angular speed. `share` 0 gives `a` and 1 gives `b`, to the bit.
[[nodiscard]] Pose between_poses(const Pose& a, const Pose& b, double share);

/// Returns the frames of a range as a motion of their own, which starts at time 0. Poses,
/// uncertainty and lineage are copied to the bit. Annotations, constraints and contact
/// edits are cut at its ends; all others are dropped. Linear in frames.
/// Precondition: the range is within the motion.
[[nodiscard]] EditState slice_state(const EditState& state, const FrameRange& frames);

/// Returns the state on another time grid: frame k shows the instant `at_frame[k]` of the
/// state (an index with its fraction). Whole numbers give poses to the bit; between, the
/// root and rotations are interpolated by cubic splines. Annotations, contacts,
/// constraints and contact edits move to the times at which their instants appear; all
/// others are dropped. Uncertainty is the larger of both neighbours'. Linear in
/// frames.
/// Precondition: `at_frame` ascends strictly within [0, frames - 1]; `rate_hz` > 0.
[[nodiscard]] EditState resample_state(const EditState& state,
                                       std::span<const double> at_frame,
                                       double rate_hz);

/// Marks frames as invented by operation `op`: their lineage is touched, its trust
/// becomes kInferred, and so does the source of every joint in their uncertainty.
void mark_invented(EditState& state, const FrameRange& frames, int op);

/// Touches the lineage of the frames, and marks as invented those in which a joint moved
/// by more than 10 mm against `before`, relative to the root if `relative` is set (for
/// operations that move the whole body rigidly, which invents nothing). Returns the
/// largest displacement. [m] Linear in frames times joints.
/// Precondition: both have the same frames and skeleton.
double mark_displaced(EditState& state,
                      const Motion& before,
                      const FrameRange& frames,
                      int op,
                      bool relative = false);

}  // namespace marey::edit
