// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Applies one operation. Pure: same input, same result, to the bit. Most operations give
/// one state; keep and split give several.
/// Errors (bad input), with the operation as place: those of the operation's own function
/// in edit/ops/; a version that this program does not have.
[[nodiscard]] Result<std::vector<EditState>> apply_op(const OpContext& context,
                                                      const EditState& state,
                                                      OpReport& report);

/// The same, and may use the memory of the state: an operation that adds an annotation
/// copies no frames.
[[nodiscard]] Result<std::vector<EditState>> apply_op(const OpContext& context,
                                                      EditState&& state,
                                                      OpReport& report);

}  // namespace marey::edit
