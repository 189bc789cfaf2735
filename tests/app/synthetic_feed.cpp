// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/synthetic_feed.h"

#include <thread>

#include "recordings/jpeg_encoder.h"

namespace marey::testing {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A JPEG picture, to be told from others by what follows its end mark.
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
  return bytes;
}

Timestamp SyntheticFeed::time_of(long k) const {
  // A little jitter, and each camera in a phase of its own.
  const long wobble_us = (k * 7919) % 300;
  return frame_time(static_cast<int>(k), {behaviour_.rate_hz}) +
         std::chrono::microseconds(1000000000 + 1700 * camera_ + wobble_us);
}

bool SyntheticFeed::is_dropped(long k) const {
  return behaviour_.drop_every > 0 && k % behaviour_.drop_every == 3;
}

std::optional<capture::RawFrame> SyntheticFeed::next(std::chrono::milliseconds timeout) {
  int dropped = 0;
  while (is_dropped(next_)) {
    ++next_;
    ++dropped;
  }
  if (behaviour_.frames >= 0 && next_ >= behaviour_.frames) {
    std::this_thread::sleep_for(timeout);
    return std::nullopt;
  }
  if (behaviour_.in_real_time) {
    std::this_thread::sleep_until(
        begin_ + frame_time(static_cast<int>(next_), {behaviour_.rate_hz}));
  }
  const bool empty = behaviour_.empty_every > 0 && next_ % behaviour_.empty_every == 5;
  bytes_ = empty ? std::vector<std::byte>() : bytes_of(next_);
  capture::RawFrame frame;
  frame.bytes = bytes_;
  frame.time = time_of(next_);
  frame.sequence = static_cast<std::uint32_t>(next_);
  frame.dropped_before = dropped;
  frame.damaged = empty;
  ++next_;
  ++handed_out_;
  return frame;
}

}  // namespace marey::testing
