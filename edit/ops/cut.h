// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"
#include "edit/state/resolve_moment.h"
#include "edit/state/timeline.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

// All of them: whole frames are kept to the bit; a span that begins between two frames is
// resampled (resample_state()). Errors: resolve_span()'s; groups or blend_s are given.

/// Keeps the span and drops the rest. The result begins at time 0.
[[nodiscard]] Result<EditState> apply_cut(const CutOp& op,
                                          const OpContext& context,
                                          const EditState& state,
                                          OpReport& report);

/// Keeps several spans, each as a motion of its own. Errors: no spans.
[[nodiscard]] Result<std::vector<EditState>> apply_keep(const KeepOp& op,
                                                        const OpContext& context,
                                                        const EditState& state,
                                                        OpReport& report);

/// Divides the motion. A frame at a division belongs to the later part.
/// Errors: no instants; instants that do not ascend, or leave a part without a frame.
[[nodiscard]] Result<std::vector<EditState>> apply_split(const SplitOp& op,
                                                         const OpContext& context,
                                                         const EditState& state,
                                                         OpReport& report);

/// Returns the frames of a part: from its start, one frame apart. A start within 1e-6 of
/// a frame is the frame's. At least one. Precondition: the span lies within the frames.
[[nodiscard]] std::vector<double> frames_of_part(const ResolvedSpan& span,
                                                 int frame_count);
/// Returns the parts that the operations keep. Errors: theirs, but for common keys.
[[nodiscard]] Result<std::vector<ResolvedSpan>> spans_of_keep(const KeepOp& op,
                                                              const Timeline& timeline);
[[nodiscard]] Result<std::vector<ResolvedSpan>> spans_of_split(const SplitOp& op,
                                                               const Timeline& timeline);

}  // namespace marey::edit
