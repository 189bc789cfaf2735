// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::recordings {

/// Returns the CRC-32 of ZIP and PNG.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes);

/// Packs files into a ZIP archive without compression. Their date is the first day of
/// 1980, ZIP's zero, so that the same files give the same bytes.
class ZipStore {
 public:
  void add(std::string_view name, std::string_view bytes);

  /// Returns the archive. nullopt if it is larger than ZIP's 4 GiB or holds more than
  /// 65534 files.
  [[nodiscard]] std::optional<std::string> finish() &&;

 private:
  std::string archive_;
  std::string directory_;  ///< Its entries, which follow the files.
  std::size_t files_ = 0;
  bool too_large_ = false;
};

/// A file in an archive, as listed in its directory. Borrows the archive.
struct ZipEntry {
  std::string_view name;
  std::string_view bytes;  ///< Empty if compressed.
  std::uint32_t crc = 0;
  bool is_compressed = false;
};

/// Returns the files of a ZIP archive without ZIP64, in the order of its directory.
/// nullopt: no such archive, or an entry extends beyond its end. Copies and unpacks
/// nothing, so memory is linear in the number of entries. Linear.
[[nodiscard]] std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive);

}  // namespace marey::recordings
