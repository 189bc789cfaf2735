// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/library/sources/list_sources.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Statements of an index table about one file.
struct IndexEntry {
  std::optional<double> rate_hz;
  std::string description;
  std::vector<std::string> labels;
  std::string subject;
  std::optional<double> duration_s;  ///< Duration of the original recording.
  int line = 0;                      ///< In the table; 0: several lines agree.
  /// Evidence for the rate, for remarks: "line 3 of data.csv", or "78 lines of data.csv
  /// with \"salsa\"".
  std::string evidence;
};

/// A table of rates and descriptions of files (`index` in library.toml).
///
/// The first line names the columns: file (or name, clip, path), or subject and trial;
/// rate_hz (rate, fps, framerate); description (motion description); labels, separated by
/// ';'; subject (actor, performer); duration (seconds), or frames counted at a rate
/// ("Frames 60fps"). Case, blanks and punctuation of names do not matter;
/// other columns are ignored. Cells are separated by commas, semicolons or tabs, and may
/// be in double quotes, with "" for a quote.
class IndexTable {
 public:
  /// Parses a table; `file` is its name in messages. Linear in the text.
  /// Errors (kBadInput), with line and column: no header, a header without a column for
  /// files or without any statement; more cells than columns; a quote that is not closed;
  /// a rate that is no number from 0.1 to 2000; two lines for one file that differ; a
  /// line without a name.
  [[nodiscard]] static Result<IndexTable> parse(std::string_view text,
                                                const std::string& file);
  /// Applies parse() to the file at `path`. Errors: also those of read_file().
  [[nodiscard]] static Result<IndexTable> read(const std::filesystem::path& path);

  /// Returns the statements about a file. It is found by
  /// - the column file: the file's name with or without folders and extension, or
  /// - subject and trial, for names "SUBJECT_TRIAL"; numbers may have leading zeros, or
  /// - its words: every word of four letters or more of the file's name is in the
  ///   description of some lines, which all state one rate ("salsa_01": "salsa dance").
  ///   These give the rate alone.
  /// nullopt: none. Linear in lines for the last one.
  [[nodiscard]] std::optional<IndexEntry> find(const SourceFile& file) const;

  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  friend class IndexReader;
  std::string file_;
  std::vector<IndexEntry> entries_;
  /// Words of four letters or more of each entry's description.
  std::vector<std::set<std::string>> words_;
  /// Entry by name: file's names, or "2_1" for subject and trial without leading zeros.
  std::map<std::string, std::size_t, std::less<>> by_name_;
  std::map<std::string, std::size_t, std::less<>> by_trial_;
};

/// Returns the labels of an entry, by "index": its description and its labels, from 0 to
/// `duration_s`, in ascending order.
[[nodiscard]] std::vector<ClipLabel> labels_of_index(const IndexEntry& entry,
                                                     double duration_s);

}  // namespace marey::app
