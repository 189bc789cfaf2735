// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_source_file.h"

#include <system_error>

#include "core/base/in_quotes.h"

namespace marey::app {

namespace fs = std::filesystem;

Result<fs::path> find_edit_file(const ReadEditOptions& options, const std::string& path) {
  const fs::path stated(path);
  const fs::path full = stated.is_absolute() ? stated : options.folder / stated;
  std::error_code absent;
  if (fs::exists(full, absent)) return full;
  const fs::path beside = options.folder / stated.filename();
  if (!stated.filename().empty() && fs::exists(beside, absent)) return beside;
  return bad_input(full.string(),
                   "does not exist, nor does " + in_quotes(stated.filename().string()) +
                       " in the recipe's folder",
                   "correct the path; it is relative to the recipe");
}

Status check_edit_source(const EditSource& source,
                         const fs::path& file,
                         const std::string& sha256,
                         const ReadEditOptions& options) {
  if (source.sha256.empty() || source.sha256 == sha256) return Done{};
  if (options.accept_new_sources) return Done{};
  return bad_input(file.string(),
                   "has another content than the recipe was made for (SHA-256 " +
                       sha256.substr(0, 12) + "..., recorded " +
                       source.sha256.substr(0, 12) + "...)",
                   "restore the file, or accept the new content with "
                   "--accept-new-source");
}

Error at_recipe_line_of(Error error, int line, const ReadEditOptions& options) {
  if (options.recipe_file.empty()) return error;
  const std::string place =
      line > 0 ? options.recipe_file + ":" + std::to_string(line) : options.recipe_file;
  error.where = place + ": " + error.where;
  return error;
}

}  // namespace marey::app
