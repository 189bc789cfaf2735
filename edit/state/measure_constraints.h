// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"

namespace marey::edit {

/// Returns the largest error of the state's constraints over the frames in which they are
/// fully active, by forward kinematics (retarget/constraints/measure_constraint.h).
/// Orientations do not count. 0: there are none, or they do not fit the body. [m]
[[nodiscard]] double worst_constraint_m(const EditState& state);

}  // namespace marey::edit
