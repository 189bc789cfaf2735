// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::recordings {

/// Keeps other users of FolderLock from the files of a folder as long as it exists: other
/// processes and other threads. For tables that are read, extended and replaced. A killed
/// process holds no lock.
class FolderLock {
 public:
  /// Locks a folder. Waits until it is free. Errors (kDevice): no such folder, or not
  /// readable; a file system without locks.
  [[nodiscard]] static Result<FolderLock> take(const std::filesystem::path& folder);

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int fd) : fd_(fd) {}

  int fd_ = -1;  ///< -1: moved from.
};

}  // namespace marey::recordings
