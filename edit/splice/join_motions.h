// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/find_splice.h"
#include "edit/splice/splice_overlap.h"
#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/frame_range.h"

namespace marey::edit {

/// The way in which two motions are joined.
struct JoinPlan {
  SpliceCandidate pair;    ///< Frames that become one instant, and the move on the floor.
  int overlap_frames = 0;  ///< 0: both motions are displaced towards each other.
  int upper_frames = 0;    ///< Overlap of trunk, head and arms, if it is longer.
  int blend_frames = 0;    ///< Decay of these displacements.
  bool align = true;       ///< The second motion is moved.
};

/// Two motions joined to one.
struct JoinedMotion {
  EditState state;
  SpliceOverlap overlap;
  FrameRange changed;  ///< Frames with a posture of neither motion; last < first: none.
  int unreachable_frames = 0;  ///< Frames in which a leg does not reach its footprint.
  bool is_seamless = false;    ///< Both show identical frames: nothing is changed.
  /// Figures of the join: turn_deg, shift_x_m, shift_z_m, raised_mm, footprint_moved_mm,
  /// slide_before_mm, slide_after_mm, displaced_mm. Findings: "reach", and those of
  /// join_states().
  OpReport report;
};

/// Joins two motions as apply_splice() documents: the overlap is planned, the second
/// motion is moved, poses are mixed or displaced, then feet are planted. `op` is the
/// operation's index for the lineage. Linear in frames.
/// Precondition: same skeleton and rate; the frames of the pair are within the motions.
[[nodiscard]] JoinedMotion join_motions(const EditState& first,
                                        const EditState& second,
                                        const JoinPlan& plan,
                                        int op);

}  // namespace marey::edit
