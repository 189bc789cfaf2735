// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/check/content_to_detect.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Detections of one video of a trial in OUT/TRIAL/detections/CAMERA.csv, with a key of
/// everything that they depend on: the bytes of the video, the detector, the wanted
/// contents, the range of frames and the rate.
class DetectionCache {
 public:
  /// Computes the key. Errors (kBadInput): the video cannot be read. Cost: that of
  /// recordings::content_key().
  [[nodiscard]] static Result<DetectionCache> open(const recordings::Session& session,
                                                   const recordings::Trial& trial,
                                                   const recordings::TrialVideo& video,
                                                   const ContentToDetect& wanted,
                                                   const std::filesystem::path& out);

  /// Returns nullopt if there is no file, or if it cannot be read or has another key: the
  /// detections are then computed again.
  [[nodiscard]] std::optional<CameraDetections> read() const;

  /// Errors: a failure of the disk.
  [[nodiscard]] Status write(const CameraDetections& camera) const;

 private:
  DetectionCache(std::filesystem::path file, std::string key);

  std::filesystem::path file_;
  std::string key_;
};

}  // namespace marey::app
