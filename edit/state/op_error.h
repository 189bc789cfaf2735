// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Returns the name of an operation with its version: "cut@1".
[[nodiscard]] std::string versioned_name(const EditOp& op);

/// Checks that this program has the version of an operation. Error (bad input): it has
/// not.
[[nodiscard]] Status check_version(const EditOp& op);

/// Returns the error of an operation with its name before the place.
[[nodiscard]] Error in_operation(Error error, const EditOp& op);

/// Returns the error with the file and the line of its operation before the place.
/// `index` is in EditRecipe::ops; `recipe_file` may be empty.
[[nodiscard]] Error at_recipe_line(Error error,
                                   const EditOp& op,
                                   std::size_t index,
                                   const std::string& recipe_file);

}  // namespace marey::edit
