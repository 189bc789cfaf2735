// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey::recordings {

/// Keeps other users of FolderLock from the files of a folder as long as it exists: other
/// processes and other threads. For tables that are read, extended and replaced. Waits
/// until the folder is free. It has no effect if the folder does not exist or the file
/// system has no locks. A killed process holds no lock.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace marey::recordings
