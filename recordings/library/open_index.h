// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"
#include "recordings/base/sqlite.h"

// Private to recordings/library: functions shared by its readers of library.sqlite.
namespace marey::recordings {

/// SQLite's application_id of library.sqlite: "MLIB".
inline constexpr int kIndexApplication = 0x4d4c4942;

/// Version of the tables of library.sqlite.
inline constexpr int kLibraryIndexVersion = 5;

/// Returns the error of an index that cannot be used (kBadInput). The next step is the
/// command that makes it again.
[[nodiscard]] Error bad_index(const std::filesystem::path& path, std::string cause);

/// Opens an index for reading, as an immutable file. Errors (kBadInput): no file; another
/// kind or version.
[[nodiscard]] Result<Database> open_index(const std::filesystem::path& path);

/// Returns the number of clips. Errors (kBadInput): a damaged index, as one whose clips
/// are not numbered from 0 on.
[[nodiscard]] Result<int> count_clips(const std::filesystem::path& path,
                                      sqlite3* database);

}  // namespace marey::recordings
