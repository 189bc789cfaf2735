// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/open_index.h"

#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

namespace marey::recordings {

Error bad_index(const std::filesystem::path& path, std::string cause) {
  const std::filesystem::path folder = path.parent_path();
  return bad_input(
      path.string(),
      std::move(cause),
      "make it again: marey library build " + (folder.empty() ? "." : folder.string()));
}

Result<Database> open_index(const std::filesystem::path& path) {
  auto database = open_recorded(path);
  if (!database) {
    if (database.error().code == Errc::kDevice) return database.error();
    return bad_index(path, database.error().cause);
  }
  if (*database == nullptr) return bad_index(path, "it cannot be opened");
  if (setting_of(database->get(), "application_id") != kIndexApplication) {
    return bad_index(path, "it is no index of a library, or it is damaged");
  }
  if (setting_of(database->get(), "user_version") != kLibraryIndexVersion) {
    return bad_index(path, "another version of marey made it");
  }
  // SQLite itself checks that all pages are there, but not that the last one is whole.
  const std::int64_t page = setting_of(database->get(), "page_size");
  std::error_code problem;
  const auto bytes = std::filesystem::file_size(path, problem);
  if (page <= 0 || problem || bytes % static_cast<std::uintmax_t>(page) != 0) {
    return bad_index(path, "it is damaged: it was cut short");
  }
  return database;
}

Result<int> count_clips(const std::filesystem::path& path, sqlite3* database) {
  // Both ends are found at once; counting would read all pages.
  Statement ends(database,
                 "SELECT coalesce((SELECT min(number) FROM clip), 0), "
                 "coalesce((SELECT max(number) FROM clip), -1)");
  if (!ends.next_row()) {
    return bad_index(path, std::string("it is damaged: ") + sqlite3_errmsg(database));
  }
  const std::int64_t last = ends.integer(1);
  // No file has more rows than bytes.
  const bool is_plausible = ends.integer(0) == 0 && last >= -1 && last < max_rows(path) &&
                            last < std::numeric_limits<int>::max();
  if (!is_plausible) return bad_index(path, "it is damaged: numbers of clips are wrong");
  return static_cast<int>(last + 1);
}

}  // namespace marey::recordings
