// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Moves and turns the whole motion about the vertical, as a rigid body with its
/// constraints. The heading is the direction from the first to the last place of the hips
/// in the span; if they are less than 0.3 m apart, the direction that the hips face at
/// PlaceOp::at. Groups and fades have no meaning here.
/// Errors: resolve_moment()'s; groups or blend_s are given; nothing to do.
[[nodiscard]] Result<EditState> apply_place(const PlaceOp& op,
                                            const OpContext& context,
                                            const EditState& state,
                                            OpReport& report);

}  // namespace marey::edit
