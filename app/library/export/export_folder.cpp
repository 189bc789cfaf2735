// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "app/shell/option_checks.h"
#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns `out` without a separator at its end, which would hide its name.
fs::path without_slash(const fs::path& out) {
  const fs::path clean = out.lexically_normal();
  return clean.has_filename() ? clean : clean.parent_path();
}

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

/// Opens and locks a folder. Returns -1 if another process holds the lock.
int lock_folder(const fs::path& folder) {
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(fd);
    return -1;
  }
  return fd;
}

Error written_by_another(const fs::path& out) {
  return bad_input(out.string(),
                   "another process is writing an export to it",
                   "wait until it ends, or choose another folder");
}

/// Moves `from` to `to`, which may be an empty folder or an earlier export; that is then
/// at `from`.
bool move_into_place(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  if (!fs::exists(to, problem) || fs::is_empty(to, problem)) {
    return std::rename(from.c_str(), to.c_str()) == 0;
  }
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) {
    return true;
  }
  // Some file systems cannot exchange.
  const fs::path old = from.string() + ".old";
  if (std::rename(to.c_str(), old.c_str()) != 0) return false;
  if (std::rename(from.c_str(), to.c_str()) == 0) {
    return std::rename(old.c_str(), from.c_str()) == 0;
  }
  const int error = errno;
  std::rename(old.c_str(), to.c_str());
  errno = error;
  return false;
}

}  // namespace

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

Result<ExportFolder> ExportFolder::create(const fs::path& out, bool replaces) {
  if (const Status ok = check_export_folder(out, replaces); !ok) return ok.error();
  const fs::path final_path = without_slash(out);
  const fs::path partial = final_path.parent_path() /
                           ("." + final_path.filename().string() + ".marey-partial");
  std::error_code problem;
  if (fs::exists(partial, problem)) {
    const int fd = lock_folder(partial);
    if (fd < 0) return written_by_another(out);
    fs::remove_all(partial, problem);
    close(fd);
  }
  fs::create_directories(partial, problem);
  if (problem) return of_disk(partial, "cannot be created", problem.value());
  const int fd = lock_folder(partial);
  if (fd < 0) return written_by_another(out);
  return ExportFolder(final_path, partial, fd);
}

ExportFolder::ExportFolder(ExportFolder&& other) noexcept
    : out_(std::move(other.out_)),
      partial_(std::exchange(other.partial_, {})),
      lock_fd_(std::exchange(other.lock_fd_, -1)) {}

ExportFolder::~ExportFolder() {
  if (partial_.empty()) return;
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  if (lock_fd_ >= 0) close(lock_fd_);
}

Status ExportFolder::commit() {
  if (const Status ok = write_manifest(partial_); !ok) return ok;
  if (!move_into_place(partial_, out_)) {
    return of_disk(out_, "the finished export cannot be moved to it", errno);
  }
  return Done{};
}

}  // namespace marey::app
