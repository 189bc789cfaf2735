// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Joins another source to the end of the motion.
///
/// Frame `at` of the motion and frame `enter_at` of the source become one instant of the
/// result. A frame that is not given is the best one (edit/find/find_splice.h). It is
/// searched in the motion within the span, or its second half without one; and in the
/// first half of the source, within 4 s of the end or the start. A source with another
/// rate or another body is fitted first (edit/splice/splice_source.h).
///
/// With `align`, the source is turned and moved on the floor so that the postures at the
/// join fit best, then shifted so that the feet that bear across the join keep their
/// footprint, and raised to the motion's floor. Its constraints move with it.
///
/// With an overlap, both motions are shown for `overlap_s` round the join
/// (edit/splice/splice_overlap.h), aligned in time by their supports, mixed with C2
/// weights, the root anchored on the bearing feet. Without one, or if a motion ends or
/// begins there, both are displaced towards each other, half of the gap each, decaying
/// over `blend_s`. Then the feet are planted in the stances that touch these frames
/// (edit/splice/plant_near.h).
///
/// Frames, overlap and decay that are not given are those of the first join, of the best
/// pairs of frames, in which no joint accelerates more than 1.1 times as much as any
/// joint of both motions (edit/splice/choose_join.h). Overlaps and decays of 0.3, 0.45,
/// 0.6 and 0.9 s are tried, for trunk, head and arms also longer ones of up to 1.2 s. If
/// all accelerate more, the join with the lowest peak is made and reported.
///
/// Frames that are identical in both motions to the bit are joined without any change: a
/// motion that is cut and spliced to its own rest is itself again.
///
/// Frames of the overlap, and those displaced by more than 10 mm, are inferred. Figures:
/// leave_frame, enter_frame, gap_mm (difference of joints at the join, rms),
/// velocity_gap_m_per_s, unchanged (1: identical frames), overlap_s (root and legs),
/// upper_overlap_s (trunk, head and arms), aligned_edges, warp_ms, opposed_s (time on
/// opposite feet), acceleration_ratio (peak of a joint in the frames that changed over
/// that of both motions), turn_deg, shift_x_m, shift_z_m, raised_mm, footprint_moved_mm,
/// slide_before_mm, slide_after_mm, displaced_mm. Findings: "acceleration", "gap",
/// "flight", "supports", "overlap", "place", "reach", "candidates", "rate", "body",
/// "uncertainty".
///
/// Errors (bad input): no such source; groups; blend_s with an overlap; a span together
/// with `at`; a span without a whole frame; resolve_moment()'s; no pair of frames that
/// stand on the same feet; a negative overlap; a motion without frames.
[[nodiscard]] Result<EditState> apply_splice(const SpliceOp& op,
                                             const OpContext& context,
                                             const EditState& state,
                                             OpReport& report);

}  // namespace marey::edit
