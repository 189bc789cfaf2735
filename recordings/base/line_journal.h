// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace marey::recordings {

/// A file of lines that is only appended to, locked for one user of it at a time. A line
/// is in the file when append() returns, so it survives the death of the process; after
/// sync() it survives the loss of power.
class LineJournal {
 public:
  /// Opens or creates the file, locks it and reads its complete lines. A last line
  /// without its end is left out; the next append() removes it.
  /// Errors (kBadInput): it is open elsewhere; not a regular file; more than 1 GiB; no
  /// permission. (kDevice): the disk failed.
  [[nodiscard]] static Result<LineJournal> open(const std::filesystem::path& path);

  LineJournal(LineJournal&& other) noexcept;
  LineJournal& operator=(LineJournal&&) = delete;
  LineJournal(const LineJournal&) = delete;
  LineJournal& operator=(const LineJournal&) = delete;
  /// Calls sync() and unlocks the file.
  ~LineJournal();

  /// Returns the lines that were in the file when it was opened, without their ends.
  [[nodiscard]] std::vector<std::string> take_lines() { return std::move(lines_); }
  /// Returns the path in messages.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Appends one line. After an error, the file is as before. Errors (kDevice): the disk
  /// is full or failed. Precondition: no line end in it.
  [[nodiscard]] Status append(std::string_view line);
  /// Waits until all lines are on the disk. Errors (kDevice): the disk failed.
  [[nodiscard]] Status sync();
  /// Calls sync() if a line is not on the disk and was appended at least `age` ago.
  [[nodiscard]] Status sync_older_than(std::chrono::milliseconds age);

 private:
  using Clock = std::chrono::steady_clock;
  LineJournal(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}
  [[nodiscard]] Status read();

  std::filesystem::path path_;
  int fd_ = -1;
  std::int64_t end_ = 0;  ///< Bytes of complete lines.
  bool is_torn_ = false;  ///< The file is longer.
  std::optional<Clock::time_point> unsynced_since_;
  std::vector<std::string> lines_;
};

}  // namespace marey::recordings
