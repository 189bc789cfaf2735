// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "recordings/base/atomic_file.h"

namespace marey::recordings {

/// Writes a TAR archive (POSIX.1-1988, "ustar") file by file, without holding it in
/// memory. Every entry is a regular file of mode 0644, owner and group 0 without names,
/// time 0: the same files give the same bytes.
class TarWriter {
 public:
  /// Errors: those of AtomicFile::create().
  [[nodiscard]] static Result<TarWriter> create(const std::filesystem::path& path);

  /// Appends a file. Preconditions: a name of 1 to 100 bytes; less than 8 GiB.
  void add(std::string_view name, std::string_view bytes);

  /// Returns the size of the archive, if it ended now.
  [[nodiscard]] std::uint64_t size() const { return written_ + kEnd; }
  /// Returns the bytes that a file of this size takes in an archive.
  [[nodiscard]] static std::uint64_t size_of_entry(std::uint64_t bytes);

  /// Ends the archive; it appears as a whole. Errors: those of AtomicFile::commit().
  [[nodiscard]] Status commit();

 private:
  static constexpr std::uint64_t kBlock = 512;
  static constexpr std::uint64_t kEnd = 2 * kBlock;  ///< Two blocks of zeros.

  explicit TarWriter(AtomicFile file) : file_(std::move(file)) {}

  AtomicFile file_;
  std::uint64_t written_ = 0;
};

/// Returns the header of a regular file in an archive of TarWriter, 512 bytes.
[[nodiscard]] std::string tar_header(std::string_view name, std::uint64_t bytes);

}  // namespace marey::recordings
