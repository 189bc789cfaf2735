// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/actions/action.h"

namespace marey::engine {

/// Computes the weights of actions at a time, by group: priority times weight times fade,
/// normalised within a layer; a layer covers the lower ones by min(1, sum of min(1,
/// priority) times fade). The sum over all actions is at most 1, less where nothing
/// covers a group. Allocates nothing.
/// Precondition: ascending by layer, then by id; one entry of `out` per action.
void action_weights(std::span<const Action* const> actions,
                    double time_s,
                    std::span<PerGroup> out);

}  // namespace marey::engine
