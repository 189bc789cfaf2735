// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// One file of a library's sources, or the folder of a session.
struct SourceFile {
  std::filesystem::path path;
  std::string name;        ///< Path relative to the library if it is below it; with '/'.
  std::string kind;        ///< source_kind(): "bvh", "session".
  std::size_t source = 0;  ///< Index of its [[source]] in the settings.
  std::uintmax_t bytes = 0;  ///< For a folder the sum of its files.
};

struct SourceListing {
  std::vector<SourceFile> files;  ///< In ascending order of their names.
  /// Number of files that no library reads, by extension with its point. Files that
  /// belong to a source (is_companion_file()) do not count.
  std::map<std::string, std::size_t> left_out;
  /// Names of folders that could not be read without permission.
  std::set<std::string> closed_folders;

  /// Files of several sources with different licences: the first one counts.
  std::vector<std::string> remarks;

  /// Returns "12 files of other kinds were left out: 10 .txt, 2 .png; 2 folders without
  /// permission were left out, the first is a/private"; empty: none.
  [[nodiscard]] std::string left_out_text() const;
};

/// Lists the files of all sources; a file of several sources belongs to the first.
/// Folders are searched with their subfolders. A folder with a session.toml is one
/// source, without the files in it, unless LibrarySource::kind names another kind. Left
/// out are hidden files, those of LibrarySource::skip, files of other kinds, and the
/// folders that a build writes (objects, search... next to a library.toml), and folders
/// below a source without permission. Errors (kBadInput), with the line: a source that
/// does not exist, is a part of the library that a build writes, is without permission,
/// or has no file that is read. (kDevice) A folder cannot be listed.
[[nodiscard]] Result<SourceListing> list_sources(const std::filesystem::path& library,
                                                 const LibrarySettings& settings);

/// Returns the values of a pattern's words in a name: {"set", "1"} for "dataset-{set}_*"
/// and "dataset-1_walk". A word ends before the text that follows it in the pattern;
/// '*' is any text. Empty: the name does not match.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> words_in_name(
    const std::string& name, const std::string& pattern);

/// Returns the person who moves in a file: LibrarySource::subject, or the value of its
/// word {subject} for the file's name, with or without its extension; empty: unknown, or
/// the name does not match. Without `subject`, {subject} in LibrarySource::pattern
/// counts.
[[nodiscard]] std::string subject_of(const SourceFile& file, const LibrarySource& source);

/// Returns the labels of the words of LibrarySource::pattern in a file's name: texts
/// "WORD:VALUE" by "name", from 0 to `duration_s`, in ascending order. {subject} is no
/// label.
[[nodiscard]] std::vector<ClipLabel> labels_of_name(const SourceFile& file,
                                                    const LibrarySource& source,
                                                    double duration_s);

}  // namespace marey::app
