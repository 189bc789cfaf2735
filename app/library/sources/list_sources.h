// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// One file of a library's sources.
struct SourceFile {
  std::filesystem::path path;
  std::string name;    ///< Path relative to the library if it is below it; with '/'.
  std::string kind;    ///< Extension without its point, in lower case: "bvh".
  std::size_t source;  ///< Index of its [[source]] in the settings.
  std::uintmax_t bytes = 0;
};

/// Returns the kinds of files that a library reads, for help and messages.
[[nodiscard]] std::string source_kinds();

/// Lists the files of all sources, in ascending order of their names; a file of several
/// sources belongs to the first. Folders are searched with their subfolders; hidden
/// files, files of other kinds and those of LibrarySource::skip are left out. Errors
/// (kBadInput), with the line: a source that does not exist, or without any file.
[[nodiscard]] Result<std::vector<SourceFile>> list_sources(
    const std::filesystem::path& library, const LibrarySettings& settings);

/// Returns the values of a pattern's words in a name: {"set", "1"} for "dataset-{set}_*"
/// and "dataset-1_walk". A word ends before the text that follows it in the pattern;
/// '*' is any text. Empty: the name does not match.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> words_in_name(
    const std::string& name, const std::string& pattern);

}  // namespace marey::app
