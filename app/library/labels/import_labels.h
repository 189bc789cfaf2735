// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "recordings/library/label_file.h"

namespace marey::app {

/// Names of a table that belong to no clip.
struct UnmatchedNames {
  std::size_t labels = 0;          ///< Number of their rows.
  std::vector<std::string> names;  ///< Each once, in the order of the table.
};

/// Labels of a table for a library.
struct ImportedLabels {
  /// Rows of clips and sources of the library, with their exact names.
  std::vector<recordings::LabelRow> rows;
  std::size_t clips = 0;     ///< Clips that get a label, each counted once.
  UnmatchedNames unknown;    ///< No clip or source has the name.
  UnmatchedNames ambiguous;  ///< Several sources fit equally well.
  int left_out = 0;          ///< Labels without text or with impossible times, of BABEL.
};

/// Reads a table of labels (.csv) or a file of BABEL (.json). Rows without an author get
/// `by`. Errors (kBadInput): those of read_labels() and read_babel(); another extension.
[[nodiscard]] Result<ImportedLabels> read_imported_labels(
    const std::filesystem::path& file, const std::string& by);

/// Replaces the names of all rows by those of LabelTargets, and moves rows without a clip
/// into the lists of names. Linear.
void match_imported_labels(std::span<const ClipRecord> records, ImportedLabels& labels);

/// The way in which a table was stored.
struct StoredTable {
  enum class State { kNew, kUnchanged, kReplaced };
  State state = State::kNew;
  std::filesystem::path file;
  std::filesystem::path backup;  ///< The former table; empty without State::kReplaced.
};

/// Stores a table of labels at `file`, unless it is there with the same content. With
/// `may_replace`, a table of other content is kept as `file`.1, .2...: the first name
/// that is free. Errors (kBadInput): a table of other content without `may_replace`;
/// those of write_file().
[[nodiscard]] Result<StoredTable> store_label_table(const std::filesystem::path& file,
                                                    const std::string& text,
                                                    bool may_replace);

}  // namespace marey::app
