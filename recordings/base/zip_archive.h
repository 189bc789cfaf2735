// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

struct zip;  // libzip's archive.

// Private to recordings/.
namespace marey::recordings {

/// Packs files into a ZIP archive without compression. Their date is the first day of
/// 1980, ZIP's zero, so that the same files give the same bytes.
class ZipWriter {
 public:
  void add(std::string name, std::string bytes);

  /// Returns the archive. nullopt if it is larger than 4 GiB, the limit of read_file().
  /// Memory: twice the files.
  [[nodiscard]] std::optional<std::string> finish() &&;

 private:
  std::vector<std::pair<std::string, std::string>> files_;  ///< Names and contents.
  std::size_t size_ = 0;  ///< About that of the archive.
};

enum class ZipProblem { kAbsent, kCompressed, kWrongChecksum, kDamaged };

/// Reads a ZIP archive in memory, whose bytes it borrows, or in a file.
class ZipReader {
 public:
  /// Returns nullopt if the bytes are no archive. Memory: some hundred bytes for each
  /// entry of its directory.
  [[nodiscard]] static std::optional<ZipReader> open(std::string_view archive);

  /// Opens an archive in a file, of which read() takes what it needs.
  [[nodiscard]] static std::optional<ZipReader> open_file(
      const std::filesystem::path& path);

  [[nodiscard]] bool contains(const std::string& name) const;
  /// Returns true if the name of a file ends with `ending`.
  [[nodiscard]] bool contains_ending(std::string_view ending) const;

  /// Returns the content of a file that is stored without compression, after a check of
  /// its checksum. The first one counts of those with the same name. All contents
  /// together have at most the size of the archive: kDamaged beyond that, as entries then
  /// overlap.
  [[nodiscard]] std::variant<std::string, ZipProblem> read(const std::string& name);

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };
  ZipReader(zip* archive, std::size_t size) : archive_(archive), unread_(size) {}

  std::unique_ptr<zip, Discard> archive_;
  std::size_t unread_ = 0;  ///< Bytes that read() may still return.
};

}  // namespace marey::recordings
