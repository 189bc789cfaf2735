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

/// A camera that is recorded.
struct RecordedCamera {
  std::string name;
  capture::FrameFeed* feed = nullptr;  ///< Not owned; outlives the recording.
};

/// Where and how long record_take() records.
struct RecordOptions {
  std::filesystem::path folder;  ///< Of this trial; created.
  std::string trial;
  std::optional<double> seconds;  ///< nullopt: until stopped.
  /// Frames of a camera that may wait for the disk, and their size together: memory that
  /// is used only while the disk is slow. 90 are three seconds of a camera that sends
  /// JPEG; of 1280x720 in YUYV 64 MB hold 36.
  std::size_t queue_frames = 90;
  std::size_t queue_bytes = std::size_t{64} << 20;
  /// What time it is on the cameras' clock; empty: CLOCK_MONOTONIC.
  std::function<Timestamp()> now;
};

/// Frame counts of one camera after a recording.
struct CameraSummary {
  std::string name;
  long frames = 0;   ///< In the video.
  long dropped = 0;  ///< Taken by the camera, and lost on the way.
  long unsaved = 0;  ///< Of these, lost because the disk was too slow.
  std::optional<Error> error;
};

}  // namespace marey::app
