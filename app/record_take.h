// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/v4l2_device.h"
#include "core/progress.h"
#include "core/result.h"

namespace marey::app {

/// A camera as the recorder sees it. One thread at a time.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;

  /// The next frame, valid until the next call; nullopt when none came within about
  /// `timeout`.
  [[nodiscard]] virtual std::optional<capture::RawFrame> next(
      std::chrono::milliseconds timeout) = 0;
  /// How frames are packed from now on.
  [[nodiscard]] virtual const capture::DeviceSettings& settings() const = 0;
  /// What the camera is: "/dev/video0 HD Webcam C920".
  [[nodiscard]] virtual std::string device() const = 0;
  /// What happened to the camera since the last call, a sentence each.
  [[nodiscard]] virtual std::vector<std::string> events() = 0;
};

struct RecordedCamera {
  std::string name;
  FrameFeed* feed = nullptr;  ///< Not owned; outlives the recording.
};

struct RecordOptions {
  std::filesystem::path folder;  ///< Of this trial; created.
  std::string trial;
  std::optional<double> seconds;  ///< nullopt: until stopped.
  /// Frames of a camera that may wait for the disk. 90 are three seconds.
  std::size_t queue_frames = 90;
};

struct CameraSummary {
  std::string name;
  long frames = 0;   ///< In the video.
  long dropped = 0;  ///< Taken by the camera, and lost on the way.
  long unsaved = 0;  ///< Of these, lost because the disk was too slow.
  std::optional<Error> error;
};

/// Records all cameras at once, until `stop` says so or the time is over:
/// FOLDER/CAMERA.mkv of each, and FOLDER/take.sqlite. JPEG pictures are kept byte for
/// byte, others are encoded. Each camera has a thread that listens to it and one that
/// writes; a camera or disk that is slow costs others nothing. What is in the files at
/// any moment is at most half a second old, also when this process is killed.
///
/// `progress` counts the frames of all cameras. Errors: there is a recording already
/// (kBadInput); the folder or files cannot be made; the take's file cannot be written to
/// (kDevice). A camera that fails is told in its summary, and the others go on.
/// Preconditions: at least one camera; names are those of files, each once.
[[nodiscard]] Result<std::vector<CameraSummary>> record_take(
    std::span<const RecordedCamera> cameras,
    const RecordOptions& options,
    const std::function<bool()>& stop,
    const Progress& progress = {});

}  // namespace marey::app
