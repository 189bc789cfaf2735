// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/file_stat.h"

#include <sys/stat.h>

namespace marey::recordings {

std::optional<FileStat> stat_file(const std::filesystem::path& path) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  struct stat state {};
  if (::stat(path.c_str(), &state) != 0) return std::nullopt;
  return FileStat{static_cast<std::uint64_t>(state.st_size),
                  state.st_mtim.tv_sec * kNanosecondsPerSecond + state.st_mtim.tv_nsec,
                  static_cast<std::uint64_t>(state.st_ino)};
}

}  // namespace marey::recordings
