// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"

#include "core/character.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::edit {

/// Supports as tracks for retarget::adapt_motion(), and the other constraints.
struct SplitConstraints {
  ConstraintSet others;
  std::vector<retarget::SupportTrack> supports;
};

/// Converts the state's Support constraints with a footprint to tracks whose targets move
/// outside of the contact. There they are on the motion's own path, displaced so that
/// they meet the footprint at the first and the last frame of contact. While a support
/// fades, it therefore adds a share of that displacement to the moving foot, and does not
/// pull it towards the footprint from afar. The rotation that a flat support adds to its
/// foot fades in 0.15 s, also through a contact of heel or ball alone. Supports without a
/// footprint, or that are never fully active at a frame, stay constraints. Linear in
/// frames times supports.
/// Precondition: retarget::check_constraints() accepts the constraints.
[[nodiscard]] SplitConstraints split_supports(const EditState& state,
                                              const Character& character);

}  // namespace marey::edit
