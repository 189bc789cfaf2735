// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"

namespace marey::edit {

/// Returns the frames, ascending, at which the vertical velocity of a foot changes by
/// more than 1 m/s: within 40 ms of the start or the end of a contact of its heel or
/// ball. The velocities before and after are means over 25 ms. The hardest of
/// impacts closer than 50 ms is kept. Side 0 is left. Linear in frames.
[[nodiscard]] std::vector<int> find_impacts(const EditState& state, int side);

}  // namespace marey::edit
