// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"

namespace marey::recordings {

/// The name of the file that tells when frames were taken, beside their videos.
inline constexpr const char* kTakeFile = "take.sqlite";

/// A frame that is in the camera's video, in its order there.
struct TakeFrame {
  Timestamp time{0};             ///< On the clock that all cameras of the take share.
  bool time_is_arrival = false;  ///< The camera's own stamp made no sense.
  std::uint32_t sequence = 0;    ///< As the driver counts; begins anew after an outage.
  int dropped_before = 0;        ///< Frames that were taken since the last and are lost.
  bool damaged = false;          ///< The driver says that its content may be wrong.
};

/// Something that happened to a camera while it was recorded.
struct TakeEvent {
  int camera = 0;  ///< In Take::cameras.
  Timestamp time{0};
  std::string text;
};

struct TakeCamera {
  std::string name;
  std::string file;  ///< Its video, beside the take's file: "cam0.mkv".
  int width_px = 0;
  int height_px = 0;
  FrameRate rate;      ///< As the device promised.
  std::string device;  ///< Path, and what the device calls itself.
  /// How the device was set, a line each: "exposure_s = 0.004".
  std::string settings;
  std::vector<TakeFrame> frames;
};

/// What was recorded of one trial.
struct Take {
  std::string trial;
  std::string started;    ///< Wall clock: "2026-11-21T11:56:29Z".
  bool finished = false;  ///< False when the recording was cut off.
  std::vector<TakeCamera> cameras;
  std::vector<TakeEvent> events;
};

/// Writes a take's file while it is recorded: an SQLite database with a write-ahead log.
/// What was committed survives the end of this process at any moment.
class TakeWriter {
 public:
  /// Makes the file, with `take`'s cameras and no frames. Errors (kDevice): the disk, and
  /// no file is left; (kBadInput): the file is there already.
  [[nodiscard]] static Result<TakeWriter> create(const std::filesystem::path& path,
                                                 const Take& take);
  TakeWriter(TakeWriter&&) noexcept;
  TakeWriter& operator=(TakeWriter&&) noexcept;
  ~TakeWriter();

  // From any thread; they do not wait for the disk. Preconditions: the camera is one of
  // the take's; times of its frames never fall, and neither they nor numbers are
  // negative.
  void add(int camera, const TakeFrame& frame);
  void note(const TakeEvent& event);

  /// Puts everything added so far into the file. To be called at least twice a second, by
  /// one thread. Errors (kDevice): the disk is full or failed.
  [[nodiscard]] Status commit();
  /// Commits, says that the recording is whole and folds the log into the one file.
  [[nodiscard]] Status finish();

 private:
  struct Impl;
  explicit TakeWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a take's file, also one that was cut off. Times of a camera's frames never fall
/// and are not negative, nor are numbers. Errors (kBadInput): it is missing; no take;
/// damaged, or with what TakeWriter would not have written; of a newer version of marey.
[[nodiscard]] Result<Take> read_take(const std::filesystem::path& path);

}  // namespace marey::recordings
