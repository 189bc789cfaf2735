// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

struct ReadEditOptions {
  std::filesystem::path folder;     ///< Paths of the recipe are relative to it.
  std::string recipe_file;          ///< For the place of errors.
  bool accept_new_sources = false;  ///< A source with another SHA-256 is accepted.
};

/// Returns the file that a recipe names: at its path, or with its name in the recipe's
/// folder. Errors (bad input): neither exists.
[[nodiscard]] Result<std::filesystem::path> find_edit_file(const ReadEditOptions& options,
                                                           const std::string& path);

/// Checks the SHA-256 of a source's file against the recorded one, if there is one.
/// Errors (bad input): it differs, and new sources are not accepted.
[[nodiscard]] Status check_edit_source(const EditSource& source,
                                       const std::filesystem::path& file,
                                       const std::string& sha256,
                                       const ReadEditOptions& options);

/// Returns the error with the recipe's file and line before its place; line 0: unknown.
[[nodiscard]] Error at_recipe_line_of(Error error,
                                      int line,
                                      const ReadEditOptions& options);

}  // namespace marey::app
