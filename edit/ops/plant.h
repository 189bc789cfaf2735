// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Makes the feet stand still during their contacts: plant_feet(), within the span.
/// Errors: op_weights()'s; groups are given: both legs and the root move.
[[nodiscard]] Result<EditState> apply_plant(const PlantOp& op,
                                            const OpContext& context,
                                            const EditState& state,
                                            OpReport& report);

}  // namespace marey::edit
