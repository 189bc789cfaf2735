// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// Version of the tables of library.sqlite.
inline constexpr int kLibraryIndexVersion = 2;

/// Makes the index of a library: a database of its records (tables in
/// docs/formats/library.md), always as a whole. It appears at `path` complete or not at
/// all; a reader of the old one is not disturbed. Clips get their numbers in the order of
/// `records`. Same records, same bytes.
/// Errors (kDevice): the disk. Memory: some megabytes for SQLite's pages. Cost: 20 s for
/// 100 000 clips with ten labels each.
/// Preconditions: ids of clips are different; numbers are finite.
[[nodiscard]] Status write_library_index(const std::filesystem::path& path,
                                         std::span<const ClipRecord> records);

}  // namespace marey::recordings
