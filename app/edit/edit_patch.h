// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "live/page/edit_request.h"

namespace marey::app {

/// Returns the avatars that a recipe names, in operations that are off, too.
[[nodiscard]] std::set<std::string> avatars_of(const EditRecipe& recipe);

/// Returns the recipe after the steps of a patch, as it is read from its own text.
/// `avatars` are the allowed values of RetargetOp::avatar. Nothing is opened.
/// Errors (kBadInput), for the page: an index that does not exist, an operation that the
/// reader of recipes declines, another avatar or source.
[[nodiscard]] Result<EditRecipe> apply_patch(const EditRecipe& recipe,
                                             const live::OpsPatch& patch,
                                             const std::set<std::string>& avatars);

/// Returns the keys of each operation of a recipe as JSON in one line: the keys and
/// values of its text.
[[nodiscard]] std::string op_keys_json(const EditOp& op);

}  // namespace marey::app
