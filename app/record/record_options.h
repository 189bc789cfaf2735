// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "capture/feeds/frame_feed.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::app {

/// Camera to record.
struct RecordedCamera {
  std::string name;
  capture::FrameFeed* feed = nullptr;  ///< Not owned; outlives the recording.
};

/// Folder, duration and buffer sizes of record_take().
struct RecordOptions {
  std::filesystem::path folder;  ///< Folder of this trial; created.
  std::string trial;
  std::optional<double> seconds;  ///< nullopt: until stopped.
  /// Largest number of frames of a camera that wait for the disk, and their total size.
  /// The memory is used only while the disk is slow. 90 frames are three seconds of a
  /// camera that sends JPEG; for 1280x720 in YUYV, 64 MB hold 36 frames.
  std::size_t queue_frames = 90;
  std::size_t queue_bytes = std::size_t{64} << 20;
  /// Returns the time on the cameras' clock; empty: CLOCK_MONOTONIC.
  std::function<Timestamp()> now;
};

/// Frame counts of one camera after a recording.
struct CameraSummary {
  std::string name;
  long frames = 0;   ///< Frames in the video.
  long dropped = 0;  ///< Captured by the camera, but lost.
  long unsaved = 0;  ///< Part of `dropped` caused by a slow disk.
  std::optional<Error> error;
};

}  // namespace marey::app
