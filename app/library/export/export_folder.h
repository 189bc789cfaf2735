// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::app {

/// Name of the list of files in every export.
inline constexpr const char* kManifest = "MANIFEST.sha256";

/// Checks that an export may be written to `out`: it does not exist, is an empty folder,
/// or is an earlier export (it has MANIFEST.sha256) with nothing else in it and
/// `replaces` is set. Errors (kBadInput), with the path.
[[nodiscard]] Status check_export_folder(const std::filesystem::path& out, bool replaces);

/// A folder that is written next to its final path, as ".NAME.marey-partial", and appears
/// there as a whole. Without commit() nothing is left behind. The partial folder is
/// locked; the next export to the same path removes that of a killed process.
class ExportFolder {
 public:
  /// Makes the partial folder. Errors: those of check_export_folder(); another process
  /// writes to the same path (kBadInput); the disk (kDevice).
  [[nodiscard]] static Result<ExportFolder> create(const std::filesystem::path& out,
                                                   bool replaces);

  ExportFolder(ExportFolder&& other) noexcept;
  ExportFolder& operator=(ExportFolder&&) = delete;
  ExportFolder(const ExportFolder&) = delete;
  ExportFolder& operator=(const ExportFolder&) = delete;
  ~ExportFolder();

  /// Folder for the files of the export.
  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }

  /// Writes MANIFEST.sha256 (lines of sha256sum(1), ascending by path) and moves the
  /// folder to its final path. An earlier export is exchanged in one step where the
  /// system can do so, and then removed. Errors: the disk (kDevice).
  [[nodiscard]] Status commit();

 private:
  ExportFolder(std::filesystem::path out, std::filesystem::path partial, int lock_fd)
      : out_(std::move(out)), partial_(std::move(partial)), lock_fd_(lock_fd) {}

  std::filesystem::path out_;
  std::filesystem::path partial_;
  int lock_fd_ = -1;
};

}  // namespace marey::app
