// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>

#include "core/base/result.h"

namespace marey::recordings {

/// A folder that is written next to its final path, as ".NAME.marey-partial", and appears
/// there as a whole; the counterpart of AtomicFile. Without commit() nothing is left
/// behind. The partial folder is locked; the next folder of the same path removes that of
/// a killed process.
class AtomicFolder {
 public:
  /// Makes the partial folder, and the folders above it. Errors: another process writes
  /// to the same path (kBadInput); the disk (kDevice).
  [[nodiscard]] static Result<AtomicFolder> create(const std::filesystem::path& path);

  AtomicFolder(AtomicFolder&& other) noexcept;
  AtomicFolder& operator=(AtomicFolder&&) = delete;
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  /// Folder for the files.
  [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }

  /// Moves the folder to its final path. A folder that is already there is exchanged in
  /// one step where the system can do so, and then removed. Errors: the disk (kDevice);
  /// the folder of before stays. Precondition: not committed.
  [[nodiscard]] Status commit();

 private:
  AtomicFolder(std::filesystem::path path, std::filesystem::path partial, int lock_fd)
      : path_(std::move(path)), partial_(std::move(partial)), lock_fd_(lock_fd) {}

  std::filesystem::path path_;
  std::filesystem::path partial_;
  int lock_fd_ = -1;
};

}  // namespace marey::recordings
