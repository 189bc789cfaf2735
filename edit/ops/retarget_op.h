// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Puts the motion on an avatar (retarget::retarget_motion(), with hands at their places
/// on the body). Frames, times, annotations, contact edits and lineage stay; every frame
/// is touched.
///
/// - Contacts: those of the state, with the avatar's heights of the ankle and ball above
///   the floor Y = 0. The avatar's feet stand during them, and during no others; so edges
///   that were changed by hand hold on the avatar, and after a new detection there.
/// - Constraints: places, boxes and distances are scaled with the body, or keep their
///   metres over the ground with keep_world; offsets on segments are scaled. Footprints
///   are the avatar's own place in the middle of the support. A constraint of a segment
///   that the avatar does not have is dropped, with a finding.
/// - Uncertainty: the sigma of the same bone, scaled; joints without a bone take their
///   parent's.
///
/// Figures: scale, slide_mm, constraints, dropped_constraints, unreachable_frames.
/// Errors (bad input): span, groups or blend_s; an avatar that was not read; those of
/// retarget::retarget_motion() and retarget::map_body().
[[nodiscard]] Result<EditState> apply_retarget(const RetargetOp& op,
                                               const OpContext& context,
                                               const EditState& state,
                                               OpReport& report);

}  // namespace marey::edit
