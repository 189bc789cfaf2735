// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Common keys that an operation can use.
struct OpKeys {
  bool span = false;
  bool groups = false;
  bool blend = false;
};

/// Checks that the operation has no key that would be ignored. The error names the key.
[[nodiscard]] Status check_op_keys(const EditOp& op, const OpKeys& usable);

}  // namespace marey::edit
