// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace marey::recordings {

/// State of a file, as the system reports it without reading the file.
struct FileStat {
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;  ///< Time of the last change, since 1970.
  std::uint64_t inode = 0;

  bool operator==(const FileStat&) const = default;
};

/// Returns the state of the file at `path`; nullopt: no such file.
[[nodiscard]] std::optional<FileStat> stat_file(const std::filesystem::path& path);

}  // namespace marey::recordings
