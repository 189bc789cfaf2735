// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::recordings {

/// Name of the file with the frame times, next to the videos.
inline constexpr const char* kTakeFile = "take.sqlite";

/// A frame of the camera's video, in the order of the video.
struct TakeFrame {
  Timestamp time{0};             ///< On the clock that all cameras of the take share.
  bool time_is_arrival = false;  ///< The camera's own timestamp was invalid.
  std::uint32_t sequence = 0;    ///< The driver's counter; restarts after an outage.
  int dropped_before = 0;        ///< Frames lost since the previous one.
  bool damaged = false;          ///< The driver reports that its content may be wrong.
};

/// An event of a camera during the recording.
struct TakeEvent {
  int camera = 0;  ///< Index in Take::cameras.
  Timestamp time{0};
  std::string text;
};

struct TakeCamera {
  std::string name;
  std::string file;  ///< Its video, next to the take's file: "cam0.mkv".
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;      ///< Rate reported by the device.
  std::string device;  ///< Path and the device's own name.
  /// Settings of the device, one per line: "exposure_s = 0.004".
  std::string settings;
  std::vector<TakeFrame> frames;
};

/// The recording of one trial.
struct Take {
  std::string trial;
  std::string started;    ///< Wall clock: "2026-11-21T11:56:29Z".
  bool finished = false;  ///< False if the recording was interrupted.
  std::vector<TakeCamera> cameras;
  std::vector<TakeEvent> events;
};

/// Writes a take's file during the recording: an SQLite database with a write-ahead log.
/// Committed data survive the end of this process at any moment.
class TakeWriter {
 public:
  /// Creates the file, with `take`'s cameras and no frames. Errors: (kDevice) a disk
  /// error, and no file is left; (kBadInput) the file already exists.
  [[nodiscard]] static Result<TakeWriter> create(const std::filesystem::path& path,
                                                 const Take& take);
  TakeWriter(TakeWriter&&) noexcept;
  TakeWriter& operator=(TakeWriter&&) noexcept;
  ~TakeWriter();

  // Callable from any thread; do not wait for the disk. Preconditions: the camera is one
  // of the take's; times of its frames never decrease; times and numbers are not
  // negative.
  void add(int camera, const TakeFrame& frame);
  void note(const TakeEvent& event);

  /// Writes everything added so far to the file. One thread calls it at least twice a
  /// second. Errors (kDevice): the disk is full or failed.
  [[nodiscard]] Status commit();
  /// Commits, marks the recording as complete and merges the log into the one file.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit TakeWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a take's file, also an interrupted one. Times of a camera's frames never
/// decrease; times and numbers are not negative. Errors (kBadInput): the file is missing;
/// not a take; damaged, or with content that TakeWriter does not write; written by a
/// newer version of marey.
[[nodiscard]] Result<Take> read_take(const std::filesystem::path& path);

}  // namespace marey::recordings
