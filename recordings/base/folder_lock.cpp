// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace marey::recordings {
namespace {

Error no_lock(const std::filesystem::path& folder, int error) {
  return {Errc::kDevice,
          folder.string(),
          std::string("the folder cannot be locked: ") + std::strerror(error),
          "check that it exists, may be read, and is on a disk with locks (flock)",
          error};
}

}  // namespace

Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  const int fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return no_lock(folder, errno);
  FolderLock out(fd);
  while (flock(fd, LOCK_EX) < 0) {
    if (errno != EINTR) return no_lock(folder, errno);
  }
  return out;
}

FolderLock::FolderLock(FolderLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

FolderLock::~FolderLock() {
  if (fd_ >= 0) close(fd_);
}

}  // namespace marey::recordings
