// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Bends and stretches the path of a motion, with the same number of footsteps (Gleicher
/// 2001, "Motion path editing").
///
/// The path is find_travel_path(). The posture keeps its place and rotation in the frame
/// of the path. Every foot in a stance moves rigidly, in place and heading, with the
/// frame at the middle of that stance, so its slide is the source's; swings interpolate.
/// Legs follow by set_feet(). `points_xz_m` give the new path as a C2 spline: the motion
/// starts at the first point; with one point only, and where the span starts within the
/// motion, the path starts where the motion is. Points in the world of constraints and
/// supports move with the frame at the middle of their time. Frames before the span stay,
/// frames after it follow rigidly. Linear in frames.
///
/// Figures: length_m, new_length_m, turn_deg (end against start), turn_rate_deg_per_s
/// (the largest while both feet bear), unreachable_frames, root_sunk_mm,
/// displaced_mm (largest displacement of a joint, relative to the root). Findings: a turn
/// rate above 60 deg/s while both feet bear; legs that do not reach; constraints that
/// last while the body travels, or spaces that cannot be turned. Errors (bad input):
/// groups, blend_s (no meaning here); points together with turn or length; points closer
/// than 1 cm; a motion that does not travel (half a leg length); a new length outside 0.7
/// to 1.3 of the old one; those of resolve_span().
[[nodiscard]] Result<EditState> apply_path(const PathOp& op,
                                           const OpContext& context,
                                           const EditState& state,
                                           OpReport& report);

}  // namespace marey::edit
