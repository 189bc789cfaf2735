// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/library_labels.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/extension.h"

namespace marey::app {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> label_tables(const fs::path& library) {
  std::vector<fs::path> out;
  std::error_code failed;
  for (fs::directory_iterator at(library / "labels", failed), end; !failed && at != end;
       at.increment(failed)) {
    const bool is_hidden = at->path().filename().string().starts_with('.');
    if (kind_by_extension(at->path()) == ".csv" && !is_hidden) out.push_back(at->path());
  }
  if (failed && failed != std::errc::no_such_file_or_directory) {
    return bad_input((library / "labels").string(),
                     "the folder cannot be read: " + failed.message(),
                     "check the folder and its permissions");
  }
  std::ranges::sort(out);
  return out;
}

Result<LibraryLabels> read_library_labels(const fs::path& library) {
  const auto tables = label_tables(library);
  if (!tables) return tables.error();
  LibraryLabels out;
  for (const fs::path& table : *tables) {
    if (table.filename() == recordings::kVerdictFile) {
      auto verdicts = recordings::read_verdicts(table);
      if (!verdicts) return verdicts.error();
      out.verdicts = *std::move(verdicts);
      continue;
    }
    auto rows = recordings::read_labels(table);
    if (!rows) return rows.error();
    out.files.push_back({"labels/" + table.filename().string(), *std::move(rows)});
  }
  return out;
}

}  // namespace marey::app
