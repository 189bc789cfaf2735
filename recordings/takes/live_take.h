// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/live_instant.h"

namespace marey::recordings {

/// Name of the file with the observations and results of a live run.
inline constexpr const char* kLiveTakeFile = "live.sqlite";

/// Metadata of a live run, stored before its first instant.
struct LiveTakeHead {
  std::string session;  ///< Its name.
  std::string started;  ///< Wall clock: "2026-11-21T11:56:29Z".
  FrameRate rate;       ///< Rate of the grid of instants.
  std::vector<std::string> cameras;
  /// All other settings that results depend on, in the program's own format.
  std::string settings;
};

/// One instant and its results.
struct LiveTakeInstant {
  LiveInstant seen;
  std::string requests;            ///< Requests of users since the previous instant.
  std::vector<std::byte> results;  ///< Poses and packets, in the program's own format.
};

struct LiveTake {
  LiveTakeHead head;
  bool finished = false;  ///< False if the recording was interrupted.
  std::vector<LiveTakeInstant> instants;
};

/// Writes a live take during the run: an SQLite database with a write-ahead log.
/// Committed data survive the end of this process at any moment.
class LiveTakeWriter {
 public:
  /// Creates the file. Errors: (kDevice) a disk error, and no file is left; (kBadInput)
  /// the file already exists.
  [[nodiscard]] static Result<LiveTakeWriter> create(const std::filesystem::path& path,
                                                     const LiveTakeHead& head);
  LiveTakeWriter(LiveTakeWriter&&) noexcept;
  LiveTakeWriter& operator=(LiveTakeWriter&&) noexcept;
  ~LiveTakeWriter();

  /// Maximum number of instants that wait for the disk: over a minute, some 100 MB.
  static constexpr std::size_t kMaxWaiting = 4096;

  /// Adds an instant. Callable from any thread; does not wait for the disk. Errors
  /// (kDevice): kMaxWaiting instants are waiting; the new one is dropped. Preconditions:
  /// numbers increase; the cameras are those of the head.
  [[nodiscard]] Status add(const LiveTakeInstant& instant);

  /// Writes everything added so far to the file. One thread calls it at least twice a
  /// second. Errors (kDevice): the disk is full or failed; no partial instant is written.
  [[nodiscard]] Status commit();
  /// Commits, marks the recording as complete and merges the log into the one file.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit LiveTakeWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a live take, also an interrupted one; numbers are exact. Errors (kBadInput): the
/// file is missing; not a live take; damaged, or with content that LiveTakeWriter does
/// not write (numbers that do not increase, cameras outside the head, values that are not
/// finite); written by a newer version of marey.
[[nodiscard]] Result<LiveTake> read_live_take(const std::filesystem::path& path);

}  // namespace marey::recordings
