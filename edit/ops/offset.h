// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"

namespace marey::edit {

/// Adds a constant displacement of one bone over the span, with C2 fades of blend_s
/// before and after it. Frames beyond the fades keep their pose to the bit. Joints and
/// feet are displaced by displace_bone(). In particular, feet stay in place when the hips
/// move ("place" moves the whole motion).
///
/// Errors (bad input): those of op_weights() and displace_bone(); a span without frames;
/// groups.
[[nodiscard]] Result<EditState> apply_offset(const OffsetOp& op,
                                             const OpContext& context,
                                             const EditState& state,
                                             OpReport& report);

}  // namespace marey::edit
