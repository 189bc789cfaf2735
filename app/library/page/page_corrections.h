// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "live/page/library_request.h"

namespace marey::app {

// Tables of a library that its page writes. `marey library build` applies them. A table
// is read, extended and replaced as a whole while its folder is locked, so that no line
// of another page is lost. `marey library annotate` refuses their names. A table with a
// mistake stays as it is. Errors of both functions: also FolderLock::take()'s.

/// Paths relative to the library.
inline constexpr const char* kVerdictTable = "labels/verdicts.csv";
inline constexpr const char* kLabelTable = "labels/page.csv";

/// Adds a line to the table of verdicts. Errors: those of recordings::add_verdict(); the
/// table is a link to a place outside the library.
[[nodiscard]] Status store_verdict(const std::filesystem::path& library,
                                   const live::LibraryVerdictRequest& verdict);

/// Adds a line to the table of labels. Times are rounded to milliseconds; `sure` is 1 or
/// 0.5. Errors: those of recordings::read_labels() and write_file(); a link as above.
[[nodiscard]] Status store_label(const std::filesystem::path& library,
                                 const live::LibraryLabelRequest& label);

}  // namespace marey::app
