// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/check_op_keys.h"

#include <string>

namespace marey::edit {
namespace {

Error unusable_key(const EditOp& op, const char* key) {
  return bad_input(key,
                   "has no meaning for " + std::string(name(op.parameters)),
                   "remove it from this operation");
}

}  // namespace

Status check_op_keys(const EditOp& op, const OpKeys& usable) {
  if (!usable.span && !op.span.is_whole()) return unusable_key(op, "the span");
  if (!usable.groups && !op.groups.empty()) return unusable_key(op, "groups");
  if (!usable.blend && op.blend_s != 0.0) return unusable_key(op, "blend_s");
  return Done{};
}

}  // namespace marey::edit
