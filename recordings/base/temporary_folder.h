// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace marey::recordings {

/// A new folder that is removed with its content.
class TemporaryFolder {
 public:
  /// Creates a folder in `above`; empty: in the system's folder for temporary files.
  explicit TemporaryFolder(std::filesystem::path above = {}) {
    std::error_code problem;
    if (above.empty()) above = std::filesystem::temp_directory_path(problem);
    std::string name = (above / "marey-XXXXXX").string();
    if (!problem && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  /// Empty: the folder could not be created.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace marey::recordings
