// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/atomic_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

/// Returns `path` without a separator at its end, which would hide its name.
fs::path without_separator(const fs::path& path) {
  const fs::path clean = fs::absolute(path).lexically_normal();
  return clean.has_filename() ? clean : clean.parent_path();
}

Error folder_error(const fs::path& path, const std::string& cause, int error) {
  return {Errc::kDevice,
          path.string(),
          cause + ": " + std::strerror(error),
          "check the free space and the permissions of the disk",
          error};
}

Error written_by_another(const fs::path& path) {
  return bad_input(path.string(),
                   "another process is writing this folder",
                   "wait until it ends, or choose another folder");
}

/// Opens and locks a folder. Returns -1 if another process holds the lock.
int lock_folder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(fd);
    return -1;
  }
  return fd;
}

/// Moves `from` to `to`. A folder with content at `to` is then at `from`.
bool move_into_place(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  if (!fs::exists(to, problem) || fs::is_empty(to, problem)) {
    return std::rename(from.c_str(), to.c_str()) == 0;
  }
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) {
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

Result<AtomicFolder> AtomicFolder::create(const fs::path& path) {
  const fs::path final_path = without_separator(path);
  const fs::path partial = final_path.parent_path() /
                           ("." + final_path.filename().string() + ".marey-partial");
  std::error_code problem;
  if (fs::exists(partial, problem)) {
    const int fd = lock_folder(partial);
    if (fd < 0) return written_by_another(path);
    fs::remove_all(partial, problem);
    ::close(fd);
  }
  fs::create_directories(partial, problem);
  if (problem) return folder_error(partial, "cannot be created", problem.value());
  const int fd = lock_folder(partial);
  if (fd < 0) return written_by_another(path);
  return AtomicFolder(final_path, partial, fd);
}

AtomicFolder::AtomicFolder(AtomicFolder&& other) noexcept
    : path_(std::move(other.path_)),
      partial_(std::exchange(other.partial_, {})),
      lock_fd_(std::exchange(other.lock_fd_, -1)) {}

AtomicFolder::~AtomicFolder() {
  if (partial_.empty()) return;
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  if (lock_fd_ >= 0) ::close(lock_fd_);
}

Status AtomicFolder::commit() {
  if (!move_into_place(partial_, path_)) {
    return folder_error(path_, "the finished folder cannot be moved to it", errno);
  }
  return Done{};
}

}  // namespace marey::recordings
