// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/edit/edit_ops.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"

namespace marey::recordings::recipe {

/// Returns the keys of a constraint of this type (an index of Goal) in [op.constraint].
[[nodiscard]] std::vector<std::string> constraint_keys(std::size_t type);

/// Reads [op.constraint] into `op`: its words are those of the constraint file
/// (docs/formats/constraints.md) with their units. A start or stop that is not in seconds
/// becomes ConstrainOp::from and to.
void read_constraint_keys(TomlReader in, ConstrainOp& op);

/// Writes the constraint of `op` as [op.constraint]. `unknown_xml` is not written.
/// Precondition: it has a constraint.
void write_constraint_keys(TomlWriter& out, const ConstrainOp& op);

}  // namespace marey::recordings::recipe
