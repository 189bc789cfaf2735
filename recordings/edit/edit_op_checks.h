// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/edit/edit_ops.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::recipe {

/// Checks keys of an operation against each other, and sets values that follow from other
/// keys: "cutoff_hz" without "cutoff" gives the cut-off itself. Mistakes: a list that
/// does not ascend, keys that exclude each other, none of several keys of which one is
/// needed.
void check_op_keys(TomlReader& in, EditOpParameters& parameters);

/// Returns the operation without values that have no effect, so that equal operations
/// have equal texts: the spline's order for a Butterworth filter, and the like.
[[nodiscard]] EditOpParameters without_idle_values(const EditOpParameters& parameters);

}  // namespace marey::recordings::recipe
