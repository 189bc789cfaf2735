// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "app/record/frame_queue.h"
#include "app/record/record_options.h"
#include "capture/feeds/frame_feed.h"
#include "recordings/takes/jpeg_encoder.h"
#include "recordings/takes/mjpg_video.h"
#include "recordings/takes/take_file.h"

// Private to record_take.cpp.
namespace marey::app {

/// The rate that players and readers are told of a camera which may not know its own.
[[nodiscard]] FrameRate rate_of(const capture::DeviceSettings& settings);

/// One camera's way into its files: listen() and write() run in a thread each.
class CameraRecorder {
 public:
  /// All that is lent outlives it.
  CameraRecorder(int number,
                 const RecordedCamera& camera,
                 const RecordOptions& options,
                 recordings::TakeWriter& take);

  /// Makes the video. Errors (kDevice): the disk; the camera packs its pictures in a way
  /// that cannot be.
  [[nodiscard]] Status open(const std::filesystem::path& video);
  /// Takes what the camera made since `begin`, until it is told to stop.
  void listen(const std::stop_token& stop, Timestamp begin);
  /// Writes what listen() took, to the end of that. `begin` as there.
  void write(Timestamp begin);

  [[nodiscard]] long frames() const { return frames_; }
  /// Once both are over, at `end` on the cameras' clock.
  [[nodiscard]] CameraSummary summary(Timestamp end) const;

 private:
  [[nodiscard]] std::optional<Error> trouble(Timestamp end) const;
  void take_frame(const capture::RawFrame& frame);
  void write_one(const QueuedFrame& frame, Timestamp begin);
  void fail(const Error& error);

  const int number_;
  const std::string name_;
  capture::FrameFeed& feed_;
  const capture::DeviceSettings settings_;  ///< As the recording began.
  FrameQueue queue_;
  recordings::TakeWriter& take_;
  std::optional<recordings::MjpgVideo> video_;
  std::optional<recordings::JpegEncoder> encoder_;
  // Of listen().
  std::optional<Timestamp> last_time_;  ///< Of the last frame that was of use.
  bool has_received_ = false;
  int lost_ = 0;  ///< Since the last frame that was taken.
  bool has_warned_of_change_ = false;
  long dropped_ = 0;
  long unsaved_ = 0;
  // Of write().
  Timestamp last_written_{0};
  int unencoded_pending_ = 0;
  long unwritten_ = 0;
  std::optional<Error> error_;
  std::atomic<long> frames_ = 0;
};

}  // namespace marey::app
