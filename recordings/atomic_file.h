// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/result.h"

namespace marey::recordings {

/// A file being written beside its final place (PATH.WORD.partial, with a word of this
/// process' own, so that two programs do not write into one). It appears at PATH, whole
/// and at once, with commit(); without one, or after any failure, nothing is left behind.
/// The partial file is locked while it is being written: what a killed process left is not
/// and is removed by the next one that creates the same file.
///
///   Result<AtomicFile> file = AtomicFile::create(path);
///   if (!file) return file.error();
///   file->append(bytes);  // As often as needed; a failure shows in commit().
///   return file->commit();
class AtomicFile {
 public:
  /// Opens the partial file, creating parent folders. Errors (kBadInput): `path` is a
  /// folder, or its folder cannot be created or written to.
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Writes at the end. What goes wrong here is kept for commit().
  /// Precondition: not committed.
  void append(std::string_view bytes);

  /// Puts the file in its place. Errors (kDevice): the disk is full or failed, or the
  /// folder has changed meanwhile.
  /// Precondition: not committed.
  [[nodiscard]] Status commit();

 private:
  explicit AtomicFile(std::filesystem::path path);
  void discard();
  void unlock();
  [[nodiscard]] bool open_partial();

  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::ofstream stream_;
  int lock_fd_ = -1;     ///< Holds the partial file's lock; -1: the disk knows no locks.
  int write_errno_ = 0;  ///< Of the first append() that failed.
  bool open_ = false;    ///< The partial file is ours to commit or to remove.
};

/// Calls `visit` with the path of each partial file that this process is writing: for a
/// signal's handler that removes them and then ends the process, and for no other use.
/// Async-signal-safe when `visit` is; a file that another thread opens at this very
/// moment may escape it, and so may all but the first 16 at once.
void visit_partial_files(void (*visit)(const char* path)) noexcept;

/// Writes `bytes` to `path`, replacing the file at once or not at all; creates parent
/// folders. Errors as AtomicFile's.
[[nodiscard]] Status write_file(const std::filesystem::path& path,
                                std::string_view bytes);

/// Returns the bytes of the file at `path`. Errors: check_input_file()'s, it may not be
/// read, or is larger than 4 GiB (kBadInput); the disk failed (kDevice).
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace marey::recordings
