// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Detects the contacts of the motion again, or changes them by hand. Changes by hand are
/// kept with the state and are applied again after each detection. Figures: left_stances,
/// right_stances. Finding: an edited contact in which the foot moves by more than 50 mm.
/// Errors: an edit beyond the motion, or whose end is before its start.
[[nodiscard]] Result<EditState> apply_contacts(const ContactsOp& op,
                                               const OpContext& context,
                                               const EditState& state,
                                               OpReport& report);

}  // namespace marey::edit
