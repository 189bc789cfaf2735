// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/mapped_file.h"

namespace marey::recordings {

// Rows of floats of many clips, in clip order (docs/formats/library.md): NAME.f32 has a
// header of 64 bytes and the rows, NAME.idx the first row of each clip. Numbers are
// little endian. A file of a single clip has no NAME.idx.

/// Writes the rows of clips one after another. Memory: 8 bytes per clip. Same rows, same
/// bytes. Both files appear whole, or neither does; NAME.idx comes first, and a reader
/// recognises files that do not belong together.
///
///   Result<RowsFileWriter> file = RowsFileWriter::create(path, 64);
///   if (!file) return file.error();
///   for (...) file->add_clip(rows);  // commit() reports a failure.
///   return file->commit();
class RowsFileWriter {
 public:
  /// Begins `path` (NAME.f32) and NAME.idx, creating parent folders. Errors: those of
  /// AtomicFile. Precondition: `columns` is positive.
  [[nodiscard]] static Result<RowsFileWriter> create(const std::filesystem::path& path,
                                                     std::size_t columns);

  RowsFileWriter(RowsFileWriter&& other) noexcept;
  RowsFileWriter& operator=(RowsFileWriter&&) = delete;
  RowsFileWriter(const RowsFileWriter&) = delete;
  RowsFileWriter& operator=(const RowsFileWriter&) = delete;
  ~RowsFileWriter();

  /// Appends the rows of the next clip, or none. Precondition: the size is a multiple of
  /// the columns; not committed.
  void add_clip(std::span<const float> rows);

  /// Puts both files in place. Errors: those of AtomicFile. Precondition: not committed.
  [[nodiscard]] Status commit();

 private:
  class Checksum;
  RowsFileWriter(std::filesystem::path path, AtomicFile file, std::size_t columns);

  std::filesystem::path path_;
  AtomicFile file_;
  std::size_t columns_ = 0;
  std::vector<std::uint64_t> begins_{0};
  std::unique_ptr<Checksum> checksum_;
};

/// Returns the bytes of a file of a single clip, without NAME.idx.
/// Precondition: `columns` is positive; the size of `rows` is a multiple of it.
[[nodiscard]] std::string rows_file_bytes(std::span<const float> rows,
                                          std::size_t columns);

/// A view of rows; valid as long as the RowsFile that it comes from.
struct RowsView {
  std::span<const float> values;
  std::size_t columns = 0;
  /// First row of each clip, and last the number of all rows: clips + 1 values.
  std::span<const std::uint64_t> begins;
};

/// Rows that are mapped, not read: pages come from the disk when they are used. The file
/// may be replaced meanwhile (the old one stays mapped), but never changed in place.
class RowsFile {
 public:
  /// Maps NAME.f32 at `path`, and reads NAME.idx. Checks the header, all sizes and
  /// NAME.idx, but not the values. Constant time, but for NAME.idx.
  /// Errors (kBadInput), with the next step: no such file; not a file of rows, or of
  /// another version; other columns; cut short or too long; NAME.idx is missing or
  /// belongs to another file.
  [[nodiscard]] static Result<RowsFile> open(const std::filesystem::path& path,
                                             std::size_t columns);

  /// Valid as long as this object, also after it was moved.
  [[nodiscard]] RowsView rows() const;

  /// Reads all values and compares their checksum with the header's. Errors (kBadInput):
  /// they differ. Cost: about 0.1 s per GB, and the disk's.
  [[nodiscard]] Status check_values() const;

 private:
  RowsFile(std::filesystem::path path, MappedFile file);

  std::filesystem::path path_;
  MappedFile file_;
  std::size_t columns_ = 0;
  std::vector<std::uint64_t> begins_;
};

}  // namespace marey::recordings
