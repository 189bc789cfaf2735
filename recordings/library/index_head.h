// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace marey::recordings {

/// State of the library that an index belongs to.
struct IndexHead {
  int version = 0;            ///< Number of the version (versions/0007.txt).
  std::string version_name;   ///< SHA-256 of that file.
  std::string search;         ///< Name of the folder of rows for searches, in search/.
  std::string inputs;         ///< SHA-256 of everything that the index was made from.
  std::string settings = {};  ///< SHA-256 of library.toml, its tables and the labels.
  std::int64_t clips = 0;
  std::int64_t warned = 0;
  std::int64_t failed = 0;
  std::int64_t duplicates = 0;
  double seconds = 0.0;      ///< Duration of all clips.
  std::string remarks = {};  ///< Remarks of the merge, one per line.
};

/// Reads the head of the index at `path`. Errors (kBadInput): no index; a damaged one, or
/// of another version of marey.
[[nodiscard]] Result<IndexHead> read_index_head(const std::filesystem::path& path);

/// Checks the structure of the index at `path`: SQLite's quick_check. Cost: reads the
/// file once; 1 s for 300 MB. Errors (kBadInput): it is damaged.
[[nodiscard]] Status check_library_index(const std::filesystem::path& path);

/// Returns the place of a file of search rows of the library whose index is at `path`:
/// "features.f32", "windows.f32" or "wholes.f32". Errors: read_index_head()'s.
[[nodiscard]] Result<std::filesystem::path> search_file(
    const std::filesystem::path& index, const std::string& name);

}  // namespace marey::recordings
