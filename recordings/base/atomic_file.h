// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::recordings {

/// Moment at which a written file is safe from a loss of power. In both cases it survives
/// the death of the process at any instant.
enum class OnDisk {
  kLater,  ///< When the system writes it.
  kNow,    ///< Before it appears at its path (fsync): some milliseconds.
};

/// A file that is written next to its final path (PATH.WORD.partial, with a word that is
/// used once, so that two writers never write into the same file). commit() moves it to
/// PATH, complete and at once; without commit(), or after any failure, no file is left
/// behind. The partial file is locked during writing. The partial file of a killed
/// process is not locked, and the next process that creates the same file removes it.
///
///   Result<AtomicFile> file = AtomicFile::create(path);
///   if (!file) return file.error();
///   file->append(bytes);  // Any number of times; commit() reports a failure.
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

  /// Appends bytes. commit() reports a failure. Precondition: not committed.
  void append(std::string_view bytes);

  /// Replaces bytes that were appended, from `offset` on: a header that is known at the
  /// end. commit() reports a failure. Preconditions: not committed; all of these bytes
  /// were appended.
  void overwrite(std::uint64_t offset, std::string_view bytes);

  /// Moves the file to its final path. Errors (kDevice): the disk is full or failed, or
  /// the folder has changed meanwhile. Precondition: not committed.
  [[nodiscard]] Status commit(OnDisk when = OnDisk::kLater);

 private:
  explicit AtomicFile(std::filesystem::path path);
  void discard();
  void unlock();
  /// Returns errno; 0: the partial file is on the disk.
  [[nodiscard]] int sync_partial() const;
  [[nodiscard]] bool open_partial();

  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::ofstream stream_;
  /// Holds the partial file's lock; -1: the file system has no locks.
  int lock_fd_ = -1;
  int write_errno_ = 0;  ///< errno of the first append() that failed.
  /// The partial file belongs to this object, which commits or removes it.
  bool open_ = false;
};

/// Removes all partial files below `folder` that killed processes of this user left.
/// Files of running processes stay. Linear in files.
void remove_abandoned_files(const std::filesystem::path& folder);

/// Calls `visit` with the path of each partial file that this process is writing. Only
/// for a signal handler that removes them and then ends the process. Async-signal-safe if
/// `visit` is. May miss a file that another thread opens at the same moment, and all but
/// the first 16 open files.
void visit_partial_files(void (*visit)(const char* path)) noexcept;

/// Writes `bytes` to `path`, replacing the file as a whole or not at all; creates parent
/// folders. Errors: those of AtomicFile.
[[nodiscard]] Status write_file(const std::filesystem::path& path,
                                std::string_view bytes,
                                OnDisk when = OnDisk::kLater);

/// Returns the bytes of the file at `path`. Errors: (kBadInput) those of
/// check_input_file(), no permission, larger than 4 GiB; (kDevice) the disk failed.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace marey::recordings
