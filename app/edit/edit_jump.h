// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "edit/jump/jump_graph.h"

#include "app/edit/edit_events.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// Computes the curves of operation `op` of a recipe. `state` is the motion that it
/// receives.
/// Errors (bad input): the recipe has no such operation, or it is not a jump; those of
/// edit::jump_graph().
[[nodiscard]] Result<edit::JumpGraph> jump_graph_of(const EditRecipe& recipe,
                                                    int op,
                                                    const edit::EditInputs& inputs,
                                                    const edit::EditState& state);

/// Returns the message `jump` for the page (docs/formats/edit_page.md): JSON in one line.
/// Heights are rounded to 0.01 mm, times to 0.01 ms and pushes to 0.0001 g.
[[nodiscard]] std::string jump_json(const EditAsker& asker, const EditJump& jump);

}  // namespace marey::app
