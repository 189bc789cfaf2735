// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capture/feeds/frame_feed.h"
#include "capture/v4l2/reopening_device.h"
#include "core/base/result.h"

namespace marey::capture {

/// A camera device that is reopened after it was unplugged. State changes are events of
/// the feed, and are also reported immediately.
class DeviceFeed final : public FrameFeed {
 public:
  /// Called with a sentence from the thread that fetches frames, and from open().
  using Report = std::function<void(const std::string&)>;

  /// `name` is the name of the camera in reports. Also reports settings of the device
  /// that differ from the request. Errors as for ReopeningDevice::open().
  [[nodiscard]] static Result<std::unique_ptr<DeviceFeed>> open(
      const std::string& name, const DeviceRequest& request, Report report);

  std::optional<RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const DeviceSettings& settings() const override;
  [[nodiscard]] std::string device() const override;
  /// At most the last 1000.
  [[nodiscard]] std::vector<FeedEvent> events() override;
  [[nodiscard]] FeedHealth health() const override;

 private:
  DeviceFeed(std::string name, Report report);
  void on_status(const CameraStatus& status);

  std::string name_;
  Report report_;
  std::vector<FeedEvent> events_;
  mutable std::mutex mutex_;
  FeedHealth health_;
  std::optional<ReopeningDevice> device_;
};

}  // namespace marey::capture
