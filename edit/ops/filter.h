// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Removes noise from a motion: the root's place, and all rotations by the construction
/// of Lee & Shin (2002), with one filter per group (filter_group.h). Impacts of a foot
/// are not noise: they divide the channels of its leg (find_impacts.h). With
/// `keep_contacts` a standing foot stays where it stood, frame by frame (held_foot.h),
/// and the leg follows by set_feet(): its own noise in contacts is left to plant. The
/// span limits the effect; the filter is chosen on the whole motion. Contacts are kept.
/// Moving the motion about the vertical before or after gives the same result to
/// rounding. Linear in frames.
///
/// Figures per group: GROUP_cutoff_hz (half power), GROUP_noise_deg,
/// GROUP_removed_rms_mm, GROUP_removed_max_mm and GROUP_removed_max_s: what was taken
/// away from the places of its joints, relative to the joint that carries the group; for
/// the root root_noise_mm and places in the world. Also impacts, feet_moved_mm (bearing
/// joints in contacts), unreachable_frames, displaced_mm. Findings: fewer than 20 frames
/// or a group without any movement, which are left as they are. Errors (bad input): an
/// order other than 2 and 3; a cut-off that is not between 0 and half the rate; those of
/// resolve_span().
[[nodiscard]] Result<EditState> apply_filter(const FilterOp& op,
                                             const OpContext& context,
                                             const EditState& state,
                                             OpReport& report);

/// Checks order and cut-off of a filter for this rate. Errors: apply_filter()'s.
[[nodiscard]] Status check_filter(const FilterOp& op, double rate_hz);

}  // namespace marey::edit
