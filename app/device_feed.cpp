// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/device_feed.h"

#include <utility>

namespace marey::app {

DeviceFeed::DeviceFeed(std::string name, Tell tell)
    : name_(std::move(name)), tell_(std::move(tell)) {}

Result<std::unique_ptr<DeviceFeed>> DeviceFeed::open(
    const std::string& name, const capture::DeviceRequest& request, Tell tell) {
  // On the heap first: the listener points to it.
  auto feed = std::unique_ptr<DeviceFeed>(new DeviceFeed(name, std::move(tell)));
  auto device = capture::ReopeningDevice::open(
      request,
      [raw = feed.get()](const capture::CameraStatus& status) { raw->hear(status); });
  if (!device) return device.error();
  feed->device_.emplace(std::move(*device));
  for (const std::string& difference : feed->settings().differences) {
    feed->tell_("camera " + name + ": " + difference);
  }
  return feed;
}

std::optional<capture::RawFrame> DeviceFeed::next(std::chrono::milliseconds timeout) {
  return device_->next(timeout);
}

const capture::DeviceSettings& DeviceFeed::settings() const {
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

void DeviceFeed::hear(const capture::CameraStatus& status) {
  {
    const std::lock_guard lock(mutex_);
    health_ = {status.state, status.trouble ? status.trouble->message() : ""};
  }
  std::string text = capture::name(status.state);
  if (status.trouble) text += ": " + status.trouble->message();
  tell_("camera " + name_ + " is " + text);
  // Live nobody fetches them, and a bad plug makes some every second.
  constexpr std::size_t kMostEvents = 1000;
  if (events_.size() == kMostEvents) events_.erase(events_.begin());
  events_.push_back({status.since, std::move(text)});
}

}  // namespace marey::app
