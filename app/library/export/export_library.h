// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "app/library/export/export_options.h"
#include "app/library/export/export_report.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Exports clips of a library as a folder (docs/formats/library_exports.md): the files of
/// the layout, MANIFEST.sha256, LICENCES.md, DATASHEET.md and splits.csv. The folder
/// appears as a whole. Same library, same options, same bytes.
///
/// `records` are all records of the library; `selected` are places in it, ascending.
/// Splits follow from all records, so a query moves no clip. Clips are read, converted
/// and written one by one; memory is that of the longest source, of the records, and of
/// MatchingSink.
///
/// A clip whose body does not fit the skeleton or the layout is left out and reported.
/// Errors: licences that do not permit the export, before anything is written; no clip is
/// selected, or all are left out; a folder that check_export_folder() refuses, at the
/// start or at the end; a missing or damaged object (kBadInput); the disk (kDevice).
/// After an error there is no folder, or the earlier export.
[[nodiscard]] Result<ExportReport> export_library(const ExportOptions& options,
                                                  std::vector<ClipRecord> records,
                                                  std::span<const int> selected,
                                                  const Progress& progress = {});

}  // namespace marey::app
