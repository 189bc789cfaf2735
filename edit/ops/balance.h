// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Keeps the centre of mass above the feet while the body stands still over them, or
/// moves slowly (retarget/balance/keep_balance.h, with the motion itself as reference,
/// whose centre of mass is moved to within 0.8 of the half size of the support area).
/// Only the root moves, at most 0.3 leg lengths; both feet keep their places, and legs
/// follow (hold_feet()). Walks and jumps, whose centre of mass is faster than 0.7 leg
/// lengths per second, stay as they are. Masses are de Leva's.
///
/// With EditBalance::kZmp: puts the zero moment point of the whole motion into the
/// support area (shift_zmp()); also of walks and jumps. Only standing feet keep their
/// places. Figures: zmp_outside_before_frames and zmp_outside_frames (loaded frames with
/// support whose zero moment point is outside), zmp_loaded_frames, max_shift_mm,
/// lowered_mm, displaced_mm. One finding names the frame that remains
/// furthest outside, another the feet that leave their places.
///
/// The shift acts by op_weights(): frames beyond span and fades keep their pose to the
/// bit, and so does a motion that needs no shift. Figures: outside_before_frames and
/// outside_frames (frames with support whose centre of mass is outside the convex hull of
/// the soles, retarget::track_balance()), supported_frames, max_shift_mm, lowered_mm,
/// displaced_mm. Linear in frames.
///
/// Errors (bad input): groups; those of op_weights() and retarget::place_masses().
[[nodiscard]] Result<EditState> apply_balance(const BalanceOp& op,
                                              const OpContext& context,
                                              const EditState& state,
                                              OpReport& report);

}  // namespace marey::edit
