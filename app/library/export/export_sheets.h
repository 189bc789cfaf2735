// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/library/export/export_options.h"
#include "app/library/export/export_report.h"

// Texts for people that every export has.
namespace marey::app {

/// Returns LICENCES.md: for each licence its conditions, whom to name, and its clips. The
/// text of a licence that is a file is included.
[[nodiscard]] std::string licences_text(const ExportReport& report,
                                        const ExportOptions& options);

/// Returns DATASHEET.md: version of the library, settings, numbers of clips and hours,
/// contents, and all that was left out with the reason.
[[nodiscard]] std::string datasheet_text(const ExportReport& report,
                                         const ExportOptions& options);

/// Returns the newest version of a library as "0007, SHA-256 ..."; "none" without one.
[[nodiscard]] std::string version_of_library(const std::filesystem::path& library);

}  // namespace marey::app
