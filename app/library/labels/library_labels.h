// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "recordings/library/label_file.h"
#include "recordings/library/verdict_file.h"

namespace marey::app {

/// A table of labels/.
struct LabelFile {
  std::string name;  ///< Path relative to the library: "labels/anna.csv".
  std::vector<recordings::LabelRow> rows;
};

/// All labels and corrections by people.
struct LibraryLabels {
  std::vector<LabelFile> files;  ///< Ascending by name.
  std::vector<recordings::VerdictCorrection> verdicts;
};

/// Returns the tables of labels/, in ascending order: files that end with .csv in any
/// case, without hidden ones. No such folder: none. Errors (kBadInput): the folder cannot
/// be read.
[[nodiscard]] Result<std::vector<std::filesystem::path>> label_tables(
    const std::filesystem::path& library);

/// Reads labels/*.csv of a library, and its labels/verdicts.csv. No such folder: no
/// labels. Hidden files are left out. Errors (kBadInput): the first mistake in a table,
/// with file, line and column. Linear.
[[nodiscard]] Result<LibraryLabels> read_library_labels(
    const std::filesystem::path& library);

}  // namespace marey::app
