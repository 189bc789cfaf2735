// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Makes a loop of one cycle of a motion (edit/ops/close_cycle.h): the best pair of
/// frames of find_loops() within the span, or the given one.
///
/// The result has `cycles` copies, each of N whole frames at the motion's rate. Its last
/// frame is the one before the repetition: frame k + N is frame k moved by the travel of
/// one cycle, and so would be the frame after the last. The travel is in the figures. A
/// body of which a foot stands during the whole cycle does not travel.
///
/// Annotations, contacts, uncertainty and lineage are those of the source's frames, in
/// each copy. The result has the annotation "loops" over its whole length, and the events
/// left.strike, left.toe_off, right.strike and right.toe_off of the cycle, that at the
/// seam included. Frames with a joint that moved by more than 10 mm against the source on
/// its new path are inferred.
///
/// Constraints that are fully active at some time of the cycle move with it
/// (carry_constraints()), and each copy has its own with a new id (repeat_constraints()).
/// Others are dropped, with a finding that has their number. With CycleDrift::kNone, a
/// constraint at a place in the world is dropped, too, if the source travels.
///
/// Errors (bad input): groups or blend_s are given (a loop is of the whole body); no
/// cycle was found; the period's limits are reversed, or longer than the motion; `from`
/// or `to` without the other, reversed, or not in the motion; cycles not in 1 to 10000;
/// fewer than 4 frames; a result of more than 5 million frames; the best gap of places is
/// above 0.15 leg lengths and `force` is not set: the message has the gap and the frames.
[[nodiscard]] Result<EditState> apply_cyclify(const CyclifyOp& op,
                                              const OpContext& context,
                                              const EditState& state,
                                              OpReport& report);

}  // namespace marey::edit
