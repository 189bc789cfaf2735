// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/library/export/export_library.h"
#include "core/library/clip_record.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

/// A small library with simulated motions: objects, index, one version.
///
///   0  walk.001   frames 110 to 169 of a walk, 60 Hz, anna, CC-BY-4.0
///   1  walk.002   frames 160 to 219 of it
///   2  child      a walk of another body, 30 Hz, bo, MIT
///   3  stiff      a body without the bone upperChest, 30 Hz, no subject, CC0-1.0
class ExportScene {
 public:
  ExportScene();

  [[nodiscard]] const std::filesystem::path& library() const { return folder_.path(); }
  /// Folder of exports, next to the library.
  [[nodiscard]] std::filesystem::path out(const std::string& name) const {
    return outside_ / name;
  }
  [[nodiscard]] std::vector<ClipRecord>& records() { return records_; }

  /// Options of an export to out(`name`), with default splits.
  [[nodiscard]] app::ExportOptions options(app::ExportFormat format,
                                           const std::string& name) const;
  /// Exports the clips with these numbers; all by default.
  [[nodiscard]] Result<app::ExportReport> run(const app::ExportOptions& options,
                                              std::vector<int> numbers = {}) const;

 private:
  ScratchFolder folder_;
  ScratchFolder outside_;
  std::vector<ClipRecord> records_;
};

/// Returns the paths of files below a folder with their SHA-256, ascending, as one text.
[[nodiscard]] std::string hash_folder(const std::filesystem::path& folder);

}  // namespace marey::testing
