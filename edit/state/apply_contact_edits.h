// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "edit/state/edit_state.h"

namespace marey::edit {

/// Changes contacts by hand: the edits, in their order. Stances follow from heel and
/// ball. Linear in frames per edit.
void apply_contact_edits(EditState& state, std::span<const ContactEdit> edits);

/// Detects the contacts of the motion again, and applies the state's contact edits.
void detect_contacts_again(EditState& state);

}  // namespace marey::edit
