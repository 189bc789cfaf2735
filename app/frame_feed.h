// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/reopening_device.h"
#include "capture/v4l2_device.h"
#include "core/time.h"

namespace marey::app {

/// Something that happened to a camera.
struct FeedEvent {
  Timestamp time{0};  ///< On the clock of the camera's frames.
  std::string text;   ///< "lost: ...".
};

/// How a camera is at this moment.
struct FeedHealth {
  capture::CameraState state = capture::CameraState::kStreaming;
  std::string trouble{};  ///< Why it does not stream.
};

/// A camera as those see it who take its frames. One thread at a time.
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
  /// What happened to the camera since the last call, in its order.
  [[nodiscard]] virtual std::vector<FeedEvent> events() = 0;
  /// No frame will come any more: a recording has ended. Cameras never do.
  [[nodiscard]] virtual bool is_over() { return false; }
  /// From any thread.
  [[nodiscard]] virtual FeedHealth health() const { return {}; }
};

}  // namespace marey::app
