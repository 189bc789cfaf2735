// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Exchanges left and right by the plane X = 0. Each bone takes the rotation of its
/// counterpart from the T-pose, mirrored: (w, x, y, z) becomes (w, x, -y, -z); so bodies
/// with different sides keep their lengths. A joint without a bone has the counterpart of
/// the same name with left and right exchanged; without one it keeps its rotation
/// relative to its parent from the rest. The path of the hips is mirrored. Contacts,
/// contact edits, constraints, uncertainty and the words left and right at the start of
/// annotations are exchanged. Applied twice it gives the motion back to 1e-12.
/// Errors: a span, groups or blend_s are given: half a mirrored body is no posture.
[[nodiscard]] Result<EditState> apply_mirror(const MirrorOp& op,
                                             const OpContext& context,
                                             const EditState& state,
                                             OpReport& report);

}  // namespace marey::edit
