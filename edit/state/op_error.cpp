// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/op_error.h"

namespace marey::edit {

std::string versioned_name(const EditOp& op) {
  return std::string(name(op.parameters)) + "@" + std::to_string(op.version);
}

Status check_version(const EditOp& op) {
  if (op.version == kEditOpVersion) return Done{};
  return bad_input(versioned_name(op),
                   "is not a version that this marey has",
                   "write " + std::string(name(op.parameters)) + "@" +
                       std::to_string(kEditOpVersion) +
                       ", or use the version of marey that the recipe was made with");
}

Error in_operation(Error error, const EditOp& op) {
  const std::string versioned = versioned_name(op);
  if (error.where.empty() || error.where == name(op.parameters)) {
    error.where = versioned;
  } else if (error.where != versioned) {
    error.where = versioned + ": " + error.where;
  }
  return error;
}

Error at_recipe_line(Error error,
                     const EditOp& op,
                     std::size_t index,
                     const std::string& recipe_file) {
  const std::string place =
      op.line > 0 ? std::to_string(op.line) : "operation " + std::to_string(index + 1);
  error.where =
      (recipe_file.empty() ? "" : recipe_file + ":") + place + ": " + error.where;
  return error;
}

}  // namespace marey::edit
