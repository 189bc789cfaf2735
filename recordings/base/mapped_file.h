// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/base/result.h"

namespace marey::recordings {

/// The bytes of a file, mapped into memory for reading. The file may be removed or
/// replaced by another one meanwhile, but not cut short: reading what is gone ends the
/// program.
class MappedFile {
 public:
  /// Maps the file at `path`. Errors: (kBadInput) those of check_input_file(), no
  /// permission; (kDevice) the file cannot be mapped.
  [[nodiscard]] static Result<MappedFile> open(const std::filesystem::path& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  /// Begins at a page of memory. Valid as long as this object, also after it was moved.
  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  MappedFile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace marey::recordings
