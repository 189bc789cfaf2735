// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace marey::recordings {

/// Places of the files of a library (docs/formats/library.md).
class LibraryPaths {
 public:
  explicit LibraryPaths(std::filesystem::path library) : library_(std::move(library)) {}

  [[nodiscard]] const std::filesystem::path& library() const { return library_; }
  [[nodiscard]] std::filesystem::path settings() const {
    return library_ / "library.toml";
  }
  [[nodiscard]] std::filesystem::path labels() const { return library_ / "labels"; }
  [[nodiscard]] std::filesystem::path index() const {
    return library_ / "library.sqlite";
  }
  /// Folder of the rows for searches; `name` is stated in the index.
  [[nodiscard]] std::filesystem::path search(const std::string& name) const {
    return library_ / "search" / name;
  }
  [[nodiscard]] std::filesystem::path search() const { return library_ / "search"; }
  [[nodiscard]] std::filesystem::path objects() const { return library_ / "objects"; }
  [[nodiscard]] std::filesystem::path versions() const { return library_ / "versions"; }
  [[nodiscard]] std::filesystem::path failed() const { return library_ / "failed"; }
  [[nodiscard]] std::filesystem::path shards() const { return library_ / "shards"; }
  [[nodiscard]] std::filesystem::path lock() const { return library_ / "LOCK"; }
  /// Local; may be deleted.
  [[nodiscard]] std::filesystem::path cache() const { return library_ / ".cache"; }

 private:
  std::filesystem::path library_;
};

}  // namespace marey::recordings
