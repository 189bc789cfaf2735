// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::recordings {

/// Name of the table in labels/ that the page of a library writes.
inline constexpr std::string_view kPageLabelFile = "page.csv";
/// Largest time of a label: a day. [s]
inline constexpr double kMaxLabel_s = 86400.0;

/// A line of a table of labels: a name for a part of a clip or of a source, by a person.
struct LabelRow {
  std::string target;  ///< Id of a clip, or the name of a source.
  /// Since the first frame of the clip, or since frame 0 of the source; nullopt: its
  /// start or its end.
  std::optional<double> start_s = std::nullopt;
  std::optional<double> end_s = std::nullopt;
  std::string text;
  std::string by;
  double certainty = 1.0;  ///< 0 to 1.
  int line = 0;            ///< In its file; 0: unknown.
};

/// Reads a table of labels (docs/formats/library.md): comma-separated, with the columns
/// clip_or_source, start_s, end_s, label, by, sure. Rows without `by` get `by`.
/// Errors (kBadInput), with file, line and column: another header; another number of
/// cells; a cell that is not a number, out of its range or empty; an end before its
/// start; bytes that are not UTF-8; labels by "marey", which a build makes. Linear.
[[nodiscard]] Result<std::vector<LabelRow>> parse_labels(std::string_view text,
                                                         const std::string& file,
                                                         const std::string& by);

/// Applies parse_labels() to the file at `path`, with the name of the file as `by`.
[[nodiscard]] Result<std::vector<LabelRow>> read_labels(
    const std::filesystem::path& path);

/// Returns the text of a table of labels. parse_labels() returns the same rows. Same
/// input, same bytes. Precondition: texts have no line ends and no blanks at their ends,
/// numbers are finite.
[[nodiscard]] std::string labels_text(std::span<const LabelRow> rows);

}  // namespace marey::recordings
