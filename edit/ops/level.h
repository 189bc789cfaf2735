// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Makes the floor under the feet level: fits a plane to the resting soles (fit_floor()),
/// turns the motion about the mean support point by the smallest rotation that takes the
/// plane's normal to +Y, and moves the floor to `floor_height_m`. A tilt hides contacts,
/// so they are detected from speeds first, then again on the levelled motion, until the
/// tilt is below 0.005 degrees (at most 6 times). Contacts of the result are those of the
/// last detection, with the edits by hand. Constraints move along. A span limits the
/// stances that are used; the whole motion moves. Linear in frames.
///
/// With footprints on one line the tilt across it is unknown, with stances at one place
/// the whole tilt: that part of the tilt is left, with a finding.
///
/// Figures: tilt_deg, tilt_sigma_deg (if observed), residual_mm (root mean square of the
/// soles' distances from the plane), largest_residual_mm, raised_mm (of the support
/// point), stances. Errors (bad input): groups, blend_s (no meaning here); no foot rests;
/// those of resolve_span().
[[nodiscard]] Result<EditState> apply_level(const LevelOp& op,
                                            const OpContext& context,
                                            const EditState& state,
                                            OpReport& report);

}  // namespace marey::edit
