// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::recordings {

/// The CRC-32 of ZIP and PNG.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes);

/// Packs files into a ZIP archive as they are, without compression. They all are of the
/// first day of 1980, ZIP's zero, so that the same files give the same bytes.
class ZipStore {
 public:
  void add(std::string_view name, std::string_view bytes);

  /// The archive. nullopt when it is larger than ZIP's 4 GiB or holds more than 65534.
  [[nodiscard]] std::optional<std::string> finish() &&;

 private:
  std::string archive_;
  std::string directory_;  ///< Its entries, which go behind the files.
  std::size_t files_ = 0;
  bool too_large_ = false;
};

}  // namespace marey::recordings
