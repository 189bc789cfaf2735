// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace marey::app {

/// The lock of a library, LIB/LOCK: one build or merge at a time, also on file systems
/// shared by several hosts, where only link(2) and rename(2) are atomic. The file states
/// the host, the process, its start, and its container's number space of processes.
class LibraryLock {
 public:
  /// Takes the lock. The lock of a process of this host that has ended is taken over.
  /// Errors: (kBadInput) another process holds it: this host's or another host's, with
  /// its name; (kDevice) the folder cannot be written to.
  [[nodiscard]] static Result<LibraryLock> take(const std::filesystem::path& library);

  LibraryLock(LibraryLock&& other) noexcept;
  LibraryLock& operator=(LibraryLock&&) = delete;
  LibraryLock(const LibraryLock&) = delete;
  LibraryLock& operator=(const LibraryLock&) = delete;
  /// Gives the lock back. Not in a child of the process that took it.
  ~LibraryLock();

 private:
  explicit LibraryLock(std::filesystem::path file, int process)
      : file_(std::move(file)), process_(process) {}

  std::filesystem::path file_;  ///< Empty: moved from.
  int process_ = 0;
};

}  // namespace marey::app
