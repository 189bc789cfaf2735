// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/library/labels/library_labels.h"
#include "app/library/sources/index_table.h"
#include "app/library/sources/list_sources.h"
#include "core/base/result.h"
#include "core/library/library_settings.h"

namespace marey::app {

/// Everything that a build reads, except the content of its sources.
struct BuildInputs {
  std::filesystem::path library;  ///< Absolute.
  LibrarySettings settings;
  /// Index table of each source in the settings; nullopt: it has none.
  std::vector<std::optional<IndexTable>> tables;
  /// Labels of people, if motions are divided by them.
  std::optional<LibraryLabels> segment_labels;
  /// SHA-256 of library.toml, the index tables and the labels.
  std::string digest;

  /// Returns the labels in `segment_labels` that name a source exactly.
  [[nodiscard]] std::vector<recordings::LabelRow> labels_of(const SourceFile& file) const;
  /// Returns what an index table states about a file; nullopt: nothing.
  [[nodiscard]] std::optional<IndexEntry> find_in_table(const SourceFile& file) const;
};

/// Reads library.toml and its tables and labels. Errors (kBadInput): no library in this
/// folder; those of their readers.
[[nodiscard]] Result<BuildInputs> read_build_inputs(const std::filesystem::path& library);

/// Replaces the names in `inputs.segment_labels` by the exact names of sources, of which
/// `names` are all of the library's. Rows that name no source, or several, are removed:
/// the merge reports them.
void name_label_sources(BuildInputs& inputs, const std::vector<std::string>& names);

/// Keys of the two stages of a source. Neither contains a path, a time or the machine.
struct SourceKeys {
  std::string motion;  ///< Reading and solving: SourceStage, and motions of its bodies.
  std::string clips;   ///< Clips of its bodies: records, and rows of features.
};

[[nodiscard]] SourceKeys keys_of(const BuildInputs& inputs,
                                 const SourceFile& file,
                                 const std::string& source_id);

}  // namespace marey::app
