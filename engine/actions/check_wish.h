// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/actions/action.h"
#include "engine/clips/motion_base.h"

#include "core/base/result.h"

namespace marey::engine {

/// Turns a request into an action with the id 0. `others` are the actions of the
/// character; `has_group` are the groups of its body.
/// Errors: those of Engine::play() about the wish.
[[nodiscard]] Result<Action> check_wish(const ActionWish& wish,
                                        const MotionBase& base,
                                        std::span<const Action> others,
                                        const std::array<bool, kGroupCount>& has_group);

/// The same for the action of a live source. Its clip is empty.
[[nodiscard]] Result<Action> check_live_wish(
    const ActionWish& wish,
    const MotionBase& base,
    std::span<const Action> others,
    const std::array<bool, kGroupCount>& has_group);

}  // namespace marey::engine
