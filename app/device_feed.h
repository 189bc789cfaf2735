// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/frame_feed.h"
#include "capture/reopening_device.h"
#include "core/result.h"

namespace marey::app {

/// A real camera, which is opened again when it was unplugged. What happens to it is an
/// event of the feed, and told at once.
class DeviceFeed final : public FrameFeed {
 public:
  /// Called with a sentence from the thread that fetches frames, and from open().
  using Tell = std::function<void(const std::string&)>;

  /// `name` is that of the camera in what is told: also how the device does otherwise
  /// than was asked for. Errors as ReopeningDevice::open().
  [[nodiscard]] static Result<std::unique_ptr<DeviceFeed>> open(
      const std::string& name, const capture::DeviceRequest& request, Tell tell);

  std::optional<capture::RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const capture::DeviceSettings& settings() const override;
  [[nodiscard]] std::string device() const override;
  /// The last 1000.
  [[nodiscard]] std::vector<FeedEvent> events() override;
  [[nodiscard]] FeedHealth health() const override;

 private:
  DeviceFeed(std::string name, Tell tell);
  void hear(const capture::CameraStatus& status);

  std::string name_;
  Tell tell_;
  std::vector<FeedEvent> events_;
  mutable std::mutex mutex_;
  FeedHealth health_;
  std::optional<capture::ReopeningDevice> device_;
};

}  // namespace marey::app
