// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Keys of all operations that one operation uses.
struct UsedKeys {
  bool span = false;
  bool groups = false;
  bool blend = false;
};

/// Returns an error for a key that is set but has no meaning for the operation. `next` is
/// the next step of the user.
[[nodiscard]] inline std::optional<Error> unused_key(const EditOp& op,
                                                     const UsedKeys& used,
                                                     const std::string& next) {
  const auto refuse = [&](const char* key) {
    return bad_input(key, "this operation does not use it", next);
  };
  if (!used.span && !op.span.is_whole()) return refuse("span");
  if (!used.groups && !op.groups.empty()) return refuse("groups");
  if (!used.blend && op.blend_s != 0.0) return refuse("blend_s");
  return std::nullopt;
}

}  // namespace marey::edit
