// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/v4l2/reopening_device.h"
#include "capture/v4l2/v4l2_device.h"
#include "core/base/time.h"

namespace marey::capture {

/// A change of a camera's state.
struct FeedEvent {
  Timestamp time{0};  ///< On the clock of the camera's frames.
  std::string text;   ///< "lost: ...".
};

/// Present state of a camera.
struct FeedHealth {
  CameraState state = CameraState::kStreaming;
  std::string trouble{};  ///< The reason if it does not stream.
};

/// A source of live frames: a camera, or a video in real time. One thread at a time.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;

  /// Returns the next frame, valid until the next call; nullopt if none arrived within
  /// about `timeout`.
  [[nodiscard]] virtual std::optional<RawFrame> next(
      std::chrono::milliseconds timeout) = 0;
  /// Returns the pixel format and size of the following frames.
  [[nodiscard]] virtual const DeviceSettings& settings() const = 0;
  /// Returns the path and name of the camera: "/dev/video0 HD Webcam C920".
  [[nodiscard]] virtual std::string device() const = 0;
  /// Returns the events since the last call, oldest first.
  [[nodiscard]] virtual std::vector<FeedEvent> events() = 0;
  /// Returns true at the end of a recording. Always false for cameras.
  [[nodiscard]] virtual bool is_over() { return false; }
  /// May be called from any thread.
  [[nodiscard]] virtual FeedHealth health() const { return {}; }
};

}  // namespace marey::capture
