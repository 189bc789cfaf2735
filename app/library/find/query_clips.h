// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// Result of a query.
struct ClipQuery {
  std::vector<int> numbers;  ///< Numbers of the selected clips, ascending.
  /// Values that no clip of the library has, with the nearest one: possible misspellings.
  std::vector<std::string> remarks;
};

/// Evaluates an expression (docs/library_queries.md) on the index of the library in this
/// folder. An empty expression, or one of blanks, selects all clips. Cost: about 20 ms
/// per condition for 100 000 clips.
/// Errors: (kUsage) the expression, with the column, the cause and the nearest known
/// word; (kBadInput) no index in the folder, a damaged one, or one of another version.
[[nodiscard]] Result<ClipQuery> run_clip_query(const std::filesystem::path& library,
                                               const std::string& expression);

/// Returns the numbers of run_clip_query().
[[nodiscard]] Result<std::vector<int>> query_clips(const std::filesystem::path& library,
                                                   const std::string& expression);

}  // namespace marey::app
