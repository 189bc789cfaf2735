// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/device_feed.h"

#include <utility>

namespace marey::capture {

DeviceFeed::DeviceFeed(std::string name, Report report)
    : name_(std::move(name)), report_(std::move(report)) {}

Result<std::unique_ptr<DeviceFeed>> DeviceFeed::open(const std::string& name,
                                                     const DeviceRequest& request,
                                                     Report report) {
  // On the heap first: the listener holds a pointer to it.
  auto feed = std::unique_ptr<DeviceFeed>(new DeviceFeed(name, std::move(report)));
  auto device = ReopeningDevice::open(
      request,
      [raw = feed.get()](const CameraStatus& status) { raw->on_status(status); });
  if (!device) return device.error();
  feed->device_.emplace(std::move(*device));
  for (const std::string& difference : feed->settings().differences) {
    feed->report_("camera " + name + ": " + difference);
  }
  return feed;
}

std::optional<RawFrame> DeviceFeed::next(std::chrono::milliseconds timeout) {
  return device_->next(timeout);
}

const DeviceSettings& DeviceFeed::settings() const {
  return device_->settings();
}

std::string DeviceFeed::device() const {
  return device_->info().path + " " + device_->info().card;
}

std::vector<FeedEvent> DeviceFeed::events() {
  return std::exchange(events_, {});
}

FeedHealth DeviceFeed::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

void DeviceFeed::on_status(const CameraStatus& status) {
  {
    const std::lock_guard lock(mutex_);
    health_ = {status.state, status.trouble ? status.trouble->message() : ""};
  }
  std::string text = name(status.state);
  if (status.trouble) text += ": " + status.trouble->message();
  report_("camera " + name_ + " is " + text);
  // In live use the events are not fetched, and a loose plug causes some every second.
  constexpr std::size_t kMaxEvents = 1000;
  if (events_.size() == kMaxEvents) events_.erase(events_.begin());
  events_.push_back({status.since, std::move(text)});
}

}  // namespace marey::capture
