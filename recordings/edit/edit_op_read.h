// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/edit/edit_ops.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::recipe {

/// Reads one [[op]]. Mistakes: no or an unknown operation or version, and those of its
/// keys.
[[nodiscard]] EditOp read_op(TomlReader& in);

}  // namespace marey::recordings::recipe
