// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/synthetic_feed.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "recordings/takes/jpeg_encoder.h"

namespace marey::testing {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Returns a JPEG picture; bytes_of() appends bytes after its end mark to distinguish
/// frames.
const std::vector<std::byte>& picture() {
  static const std::vector<std::byte> jpeg = [] {
    auto encoder = recordings::JpegEncoder::create(
        recordings::RawLayout::kGrey, kWidth, kHeight, kWidth);
    const std::vector<std::byte> grey(std::size_t{kWidth} * kHeight, std::byte{90});
    const auto bytes = encoder->encode(grey);
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  }();
  return jpeg;
}

}  // namespace

SyntheticFeed::SyntheticFeed(int camera, const Behaviour& behaviour)
    : camera_(camera), behaviour_(behaviour) {
  settings_.format =
      behaviour.is_grey ? capture::PixelFormat::kGrey : capture::PixelFormat::kMjpg;
  settings_.width_px = kWidth;
  settings_.height_px = kHeight;
  settings_.stride = behaviour.is_grey ? kWidth : 0;
  settings_.rate = {behaviour.rate_hz};
  settings_.exposure_s = 0.004;
  settings_.monotonic_clock = true;
}

std::vector<std::byte> SyntheticFeed::bytes_of(long k) const {
  if (behaviour_.is_grey) {
    return std::vector<std::byte>(std::size_t{kWidth} * kHeight,
                                  static_cast<std::byte>(k % 200));
  }
  std::vector<std::byte> bytes = picture();
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<std::byte>(k >> (8 * i)));
  bytes.push_back(static_cast<std::byte>(camera_));
  const bool is_big = behaviour_.big_every > 0 && k % behaviour_.big_every == 7;
  if (is_big) bytes.resize(bytes.size() + behaviour_.big_bytes, std::byte{7});
  return bytes;
}

Timestamp SyntheticFeed::time_of(long k) const {
  // A little jitter, and each camera in a phase of its own.
  const long wobble_us = (k * 7919) % 300;
  return frame_time(static_cast<int>(k - behaviour_.stale), {behaviour_.rate_hz}) +
         std::chrono::microseconds(1000000000 + 1700 * camera_ + wobble_us);
}

Timestamp SyntheticFeed::event_time(long k) const {
  return time_of(k) - std::chrono::milliseconds(3);
}

Timestamp SyntheticFeed::now() const {
  return time_of(std::max(next_.load(), behaviour_.stale));
}

bool SyntheticFeed::is_dropped(long k) const {
  return behaviour_.drop_every > 0 && k % behaviour_.drop_every == 3;
}

std::vector<capture::FeedEvent> SyntheticFeed::events() {
  return std::exchange(events_, {});
}

std::optional<capture::RawFrame> SyntheticFeed::next(std::chrono::milliseconds timeout) {
  int dropped = 0;
  long k = next_;
  for (; is_dropped(k); ++k) ++dropped;
  if (behaviour_.frames >= 0 && k >= behaviour_.frames) {
    next_ = k;
    std::this_thread::sleep_for(std::min(timeout, std::chrono::milliseconds(5)));
    return std::nullopt;
  }
  if (behaviour_.in_real_time) {
    std::this_thread::sleep_until(begin_ +
                                  frame_time(static_cast<int>(k), {behaviour_.rate_hz}));
  }
  const auto event = behaviour_.events.find(k);
  if (event != behaviour_.events.end()) {
    events_.push_back({event_time(k), event->second});
  }
  if (k == behaviour_.other_size_from) settings_.width_px *= 2;
  if (k > 0 && k == behaviour_.stale) dropped += behaviour_.dropped_after_stale;
  const bool empty = behaviour_.empty_every > 0 && k % behaviour_.empty_every == 5;
  bytes_ = empty ? std::vector<std::byte>() : bytes_of(k);
  capture::RawFrame frame;
  frame.bytes = bytes_;
  frame.time = time_of(k);
  frame.sequence = static_cast<std::uint32_t>(k);
  frame.dropped_before = dropped;
  frame.damaged = empty;
  ++handed_out_;
  next_ = k + 1;
  return frame;
}

app::RecordOptions options_for(const std::filesystem::path& folder,
                               const SyntheticFeed& feed) {
  app::RecordOptions options;
  options.folder = folder;
  options.trial = "walk";
  options.queue_frames = 1000;
  options.now = [&feed] { return feed.now(); };
  return options;
}

}  // namespace marey::testing
