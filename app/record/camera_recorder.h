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

/// Returns the nominal rate for players and readers: 30 Hz if the camera states none.
[[nodiscard]] FrameRate rate_of(const capture::DeviceSettings& settings);

/// Records one camera: receive() and write() each run in a thread of their own.
class CameraRecorder {
 public:
  /// Precondition: all arguments outlive the recorder.
  CameraRecorder(int number,
                 const RecordedCamera& camera,
                 const RecordOptions& options,
                 recordings::TakeWriter& take);

  /// Creates the video. Errors (kDevice): the file cannot be written; the pictures have
  /// an invalid layout.
  [[nodiscard]] Status open(const std::filesystem::path& video);
  /// Queues the frames of the camera from `begin` on, until `stop` is requested.
  void receive(const std::stop_token& stop, Timestamp begin);
  /// Writes the queued frames until the queue is over. `begin` as in receive().
  void write(Timestamp begin);

  [[nodiscard]] long frames() const { return frames_; }
  /// Returns the counts and the error of the camera. `end` is on the clock of the
  /// cameras. Precondition: receive() and write() have returned.
  [[nodiscard]] CameraSummary summary(Timestamp end) const;

 private:
  [[nodiscard]] std::optional<Error> trouble(Timestamp end) const;
  void take_frame(const capture::RawFrame& frame);
  void write_one(const QueuedFrame& frame, Timestamp begin);
  void fail(const Error& error);

  const int number_;
  const std::string name_;
  capture::FrameFeed& feed_;
  const capture::DeviceSettings settings_;  ///< Settings at the start.
  FrameQueue queue_;
  recordings::TakeWriter& take_;
  std::optional<recordings::MjpgVideo> video_;
  std::optional<recordings::JpegEncoder> encoder_;
  // Used by receive().
  std::optional<Timestamp> last_time_;  ///< Time of the last usable frame.
  bool has_received_ = false;
  int lost_ = 0;  ///< Frames lost since the last queued frame.
  bool has_warned_of_change_ = false;
  long dropped_ = 0;
  long unsaved_ = 0;
  // Used by write().
  Timestamp last_written_{0};
  int unencoded_pending_ = 0;
  long unwritten_ = 0;
  std::optional<Error> error_;
  std::atomic<long> frames_ = 0;
};

}  // namespace marey::app
