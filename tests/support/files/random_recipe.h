// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/edit/edit_recipe.h"

namespace marey::testing {

/// Returns an operation of each kind with random values for its keys, most of them not
/// the defaults: `kind` is the index in EditOpParameters, modulo their number. It is
/// valid in a recipe with sources "", "s1" and "s2": its text can be parsed. The same
/// arguments give the same operation on every machine.
[[nodiscard]] EditOp random_edit_op(std::uint64_t seed, std::size_t kind);

/// Returns a valid recipe of up to `max_ops` random operations, with three sources and
/// random limits. The operations suit no motion in particular.
[[nodiscard]] EditRecipe random_edit_recipe(std::uint64_t seed, std::size_t max_ops = 12);

}  // namespace marey::testing
