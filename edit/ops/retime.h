// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"
#include "edit/state/timeline.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Changes the time of the motion. Knots: core/time_warp.h, exact at every knot; before
/// the first knot the start of the motion stays the start, after the last the speed is 1.
/// Poses between frames: resample_state(), whose splines add no frequency above half the
/// old rate. Annotations, contacts and constraints move along.
/// Errors: knots not ascending in both times; a speed outside 1/20 to 20; more than one
/// of knots, speed and duration; none; a span, groups or blend_s; more than 5 million
/// frames.
[[nodiscard]] Result<EditState> apply_retime(const RetimeOp& op,
                                             const OpContext& context,
                                             const EditState& state,
                                             OpReport& report);

/// Frames of a retimed recording, as resample_state() takes them.
struct RetimedFrames {
  std::vector<double> at_frame;  ///< Ascends strictly.
  double rate_hz = 0.0;
};
/// Errors: apply_retime()'s, but for common keys.
[[nodiscard]] Result<RetimedFrames> retimed_frames(const RetimeOp& op,
                                                   const Timeline& timeline);

}  // namespace marey::edit
