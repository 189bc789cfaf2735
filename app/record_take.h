// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/frame_feed.h"
#include "core/progress.h"
#include "core/result.h"
#include "core/time.h"

namespace marey::app {

struct RecordedCamera {
  std::string name;
  FrameFeed* feed = nullptr;  ///< Not owned; outlives the recording.
};

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

struct CameraSummary {
  std::string name;
  long frames = 0;   ///< In the video.
  long dropped = 0;  ///< Taken by the camera, and lost on the way.
  long unsaved = 0;  ///< Of these, lost because the disk was too slow.
  std::optional<Error> error;
};

/// Whether `folder` has nothing that a recording of these cameras would write over.
/// Errors (kBadInput): there is a recording, or part of one.
[[nodiscard]] Status check_unrecorded(const std::filesystem::path& folder,
                                      std::span<const std::string> cameras);

/// Records all cameras at once, until `stop` says so or the time is over:
/// FOLDER/CAMERA.mkv of each, and FOLDER/take.sqlite. JPEG pictures are kept byte for
/// byte, others are encoded. Each camera has a thread that listens to it and one that
/// writes; a camera or disk that is slow costs others nothing. Frames from before the
/// beginning are not of the take. What is in the files at any moment is at most half a
/// second old, also when this process is killed.
///
/// `progress` counts the frames of all cameras. Errors: those of check_unrecorded(); the
/// folder or files cannot be made; a camera's pictures cannot be recorded; the take's
/// file cannot be written to (kDevice). Where it cannot begin, nothing is left behind. A
/// camera that fails, sends nothing in the last second, or comes back with other pictures
/// is told in its summary, and the others go on.
/// Preconditions: at least one camera; names are those of files, each once.
[[nodiscard]] Result<std::vector<CameraSummary>> record_take(
    std::span<const RecordedCamera> cameras,
    const RecordOptions& options,
    const std::function<bool()>& stop,
    const Progress& progress = {});

}  // namespace marey::app
