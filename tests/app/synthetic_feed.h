// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/record/record_take.h"
#include "capture/feeds/frame_feed.h"

namespace marey::testing {

/// A simulated camera. The content of frame k depends only on `camera` and k, so that a
/// test can compute the expected recording. The simulated clock advances by one period
/// per frame, independent of the real duration.
class SyntheticFeed final : public capture::FrameFeed {
 public:
  struct Behaviour {
    double rate_hz = 100.0;
    long frames = -1;           ///< After so many it is silent; -1: it never ends.
    int drop_every = 0;         ///< Each so-many-th frame never comes; 0: all come.
    bool is_grey = false;       ///< Raw pixels instead of JPEG.
    int empty_every = 0;        ///< Each so-many-th frame is without bytes.
    bool in_real_time = false;  ///< Else as fast as they are fetched.
    long stale = 0;             ///< The first so many frames are from before now().
    int dropped_after_stale = 0;
    long other_size_from = -1;  ///< From this frame on pictures are wider; -1: never.
    int big_every = 0;          ///< Each so-many-th frame has `big_bytes` more.
    std::size_t big_bytes = 0;
    std::map<long, std::string> events{};  ///< Before frame k: event_time(k).
  };

  SyntheticFeed(int camera, const Behaviour& behaviour);

  std::optional<capture::RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const capture::DeviceSettings& settings() const override {
    return settings_;
  }
  [[nodiscard]] std::string device() const override { return "synthetic"; }
  std::vector<capture::FeedEvent> events() override;

  /// Before anything is fetched.
  [[nodiscard]] capture::DeviceSettings& settings_to_spoil() { return settings_; }

  // From any thread. handed_out() counts the frames so far; is_done() is true after the
  // last one. now() is the time of the next frame on the feed's clock, at first the time
  // of the frame after the stale ones.
  [[nodiscard]] long handed_out() const { return handed_out_; }
  [[nodiscard]] bool is_done() const {
    return behaviour_.frames >= 0 && next_ >= behaviour_.frames;
  }
  [[nodiscard]] Timestamp now() const;

  /// Return the content of frame k, its time, the time of its event, and whether it is
  /// dropped.
  [[nodiscard]] std::vector<std::byte> bytes_of(long k) const;
  [[nodiscard]] Timestamp time_of(long k) const;
  [[nodiscard]] Timestamp event_time(long k) const;
  [[nodiscard]] bool is_dropped(long k) const;

 private:
  int camera_;
  Behaviour behaviour_;
  capture::DeviceSettings settings_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::atomic<long> next_ = 0;
  std::atomic<long> handed_out_ = 0;
  std::vector<std::byte> bytes_;
  std::vector<capture::FeedEvent> events_;
};

/// To record the trial "walk" into `folder` on the clock of `feed`, the first of the
/// cameras, with room for all that comes however slow the disk is. The feed must live as
/// long as the options.
[[nodiscard]] app::RecordOptions options_for(const std::filesystem::path& folder,
                                             const SyntheticFeed& feed);

}  // namespace marey::testing
