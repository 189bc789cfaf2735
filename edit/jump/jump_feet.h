// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dynamics/jumps/plan_jump.h"
#include "edit/state/edit_state.h"

#include "retarget/com/follow_com.h"

namespace marey::edit {

/// Returns the wanted feet of a jump, left and right, one goal per frame. `state` is the
/// captured motion at the times of the new one, with its contacts; its frame k shows
/// frame `shown[k]` of `captured`. Feet that bear keep
/// their places: the captured ones before the flight, displaced with the landing after
/// it. A foot that bears shortly before take-off stands until take-off, one that bears
/// shortly after touch-down from touch-down on. In flight feet follow the body. While the
/// body pushes off or lands, heels may rise. Linear in frames.
[[nodiscard]] std::array<std::vector<retarget::FootGoal>, 2> jump_feet(
    const EditState& captured,
    std::span<const double> shown,
    const EditState& state,
    const dynamics::JumpPlan& plan);

}  // namespace marey::edit
