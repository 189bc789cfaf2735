// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_folder.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "app/shell/option_checks.h"
#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

Error of_disk(const fs::path& path, const std::string& cause, int error) {
  return {Errc::kDevice,
          path.string(),
          cause + ": " + std::strerror(error),
          "check the free space and the permissions of the disk",
          error};
}

/// Returns the files below a folder, relative to it, ascending.
Result<std::vector<std::string>> files_below(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code problem;
  auto at = fs::recursive_directory_iterator(folder, problem);
  for (; !problem && at != fs::recursive_directory_iterator(); at.increment(problem)) {
    if (at->is_directory() && !at->is_symlink()) continue;
    out.push_back(at->path().lexically_relative(folder).generic_string());
  }
  if (problem) return of_disk(folder, "cannot be listed", problem.value());
  std::ranges::sort(out);
  return out;
}

/// Checks that an earlier export has no files of others, which a replacement would
/// remove.
Status check_only_exported(const fs::path& out) {
  const auto manifest = recordings::read_file(out / kManifest);
  if (!manifest) return manifest.error();
  std::set<std::string> known{kManifest};
  constexpr std::size_t kDigits = 64;
  for (std::size_t begin = 0; begin < manifest->size();) {
    const std::size_t end = std::min(manifest->find('\n', begin), manifest->size());
    if (end - begin > kDigits + 2) {
      known.insert(manifest->substr(begin + kDigits + 2, end - begin - kDigits - 2));
    }
    begin = end + 1;
  }
  const auto files = files_below(out);
  if (!files) return files.error();
  for (const std::string& file : *files) {
    if (known.contains(file)) continue;
    return bad_input(out.string(),
                     in_quotes(file) + " in it is not a file of an export",
                     "move this file elsewhere, or choose another folder");
  }
  return Done{};
}

}  // namespace

Status check_outside(const fs::path& out, const fs::path& library) {
  std::error_code failed;
  const fs::path full = fs::weakly_canonical(fs::absolute(out, failed), failed);
  const fs::path below = full.lexically_relative(
      fs::weakly_canonical(fs::absolute(library, failed), failed));
  const bool is_below = !below.empty() && *below.begin() != "..";
  if (!is_below) return Done{};
  return bad_input(out.string(),
                   "it is in the folder of the library, whose builds use it",
                   "give a folder outside the library with --to");
}

Status check_export_folder(const fs::path& out, bool replaces) {
  if (const Status ok = check_out_folder(out); !ok) return ok;
  std::error_code problem;
  if (!fs::exists(out, problem) || fs::is_empty(out, problem)) return Done{};
  if (!fs::is_regular_file(out / kManifest, problem)) {
    return bad_input(out.string(),
                     "it is not empty, and no earlier export of marey",
                     "give a new folder with --to");
  }
  if (!replaces) {
    return bad_input(out.string(),
                     "it is an earlier export",
                     "add --replace to exchange it, or give a new folder with --to");
  }
  return check_only_exported(out);
}

Status write_manifest(const fs::path& folder) {
  const auto files = files_below(folder);
  if (!files) return files.error();
  std::string text;
  for (const std::string& file : *files) {
    const auto digest = recordings::sha256_of_file(folder / file);
    if (!digest) return digest.error();
    text += *digest + "  " + file + "\n";
  }
  return recordings::write_file(folder / kManifest, text);
}

}  // namespace marey::app
