// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/live_instant.h"
#include "core/result.h"

namespace marey::recordings {

/// The name of the file that holds what a live run saw and what came of it.
inline constexpr const char* kLiveTakeFile = "live.sqlite";

/// What a live run says of itself before its first instant.
struct LiveTakeHead {
  std::string session;   ///< Its name.
  std::string started;   ///< Wall clock: "2026-11-21T11:56:29Z".
  FrameRate rate;        ///< Of the grid of instants.
  std::vector<std::string> cameras;
  std::string settings;  ///< All else that results depend on, as the program keeps it.
};

/// One instant, and what came of it.
struct LiveTakeInstant {
  LiveInstant seen;
  std::string requests;            ///< What users asked for since the instant before.
  std::vector<std::byte> results;  ///< Poses and packets, as the program keeps them.
};

struct LiveTake {
  LiveTakeHead head;
  bool finished = false;  ///< False when the recording was cut off.
  std::vector<LiveTakeInstant> instants;
};

/// Writes a live take while it happens: an SQLite database with a write-ahead log. What
/// was committed survives the end of this process at any moment.
class LiveTakeWriter {
 public:
  /// Errors (kDevice): the disk, and no file is left; (kBadInput): it is there already.
  [[nodiscard]] static Result<LiveTakeWriter> create(const std::filesystem::path& path,
                                                     const LiveTakeHead& head);
  LiveTakeWriter(LiveTakeWriter&&) noexcept;
  LiveTakeWriter& operator=(LiveTakeWriter&&) noexcept;
  ~LiveTakeWriter();

  /// How many instants may wait for the disk: a minute and more, some 100 MB.
  static constexpr std::size_t kMostWaiting = 4096;

  /// From any thread; does not wait for the disk. Errors (kDevice): kMostWaiting are
  /// waiting; the instant is not kept. Preconditions: numbers grow; cameras are the
  /// head's.
  [[nodiscard]] Status add(const LiveTakeInstant& instant);

  /// Puts everything added so far into the file. To be called at least twice a second, by
  /// one thread. Errors (kDevice): the disk is full or failed; nothing is half-written.
  [[nodiscard]] Status commit();
  /// Commits, says that the recording is whole and folds the log into the one file.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit LiveTakeWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a live take, also one that was cut off; numbers are exact. Errors (kBadInput):
/// it is missing; no live take; damaged, or with what LiveTakeWriter would not have
/// written: numbers that do not grow, cameras that are not the head's, values that are
/// not finite; of a newer version of marey.
[[nodiscard]] Result<LiveTake> read_live_take(const std::filesystem::path& path);

}  // namespace marey::recordings
