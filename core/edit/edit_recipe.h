// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/edit/edit_ops.h"

namespace marey {

/// A motion that a recipe edits.
struct EditSource {
  std::string id;    ///< Empty for the first one, unless stated.
  std::string path;  ///< Relative to the recipe's folder, or absolute.
  std::string
      sha256;    ///< SHA-256 of the file, 64 lower-case digits; empty: not recorded yet.
  int line = 0;  ///< In the recipe's file; 0: unknown.
  bool operator==(const EditSource&) const = default;
};

/// Largest figures that a result may have; nullopt: no limit.
struct EditLimits {
  std::optional<double> slide_mm;  ///< Drift of a foot within one contact.
  std::optional<double>
      displaced_mm;  ///< Displacement of a joint or a marker by one operation.
  std::optional<double> constraint_mm;       ///< Error of a constraint.
  std::optional<double> acceleration_ratio;  ///< Peak against the source's peak.
  bool operator==(const EditLimits&) const = default;
};

/// An edit as a list of operations (a `.edit.toml` file).
struct EditRecipe {
  std::string name;
  std::vector<EditSource> sources;  ///< At least one; the first is edited.
  std::vector<EditOp> ops;
  EditLimits limits;
};

}  // namespace marey
