// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "app/frame_feed.h"
#include "app/monotonic_clock.h"
#include "capture/group_frames.h"
#include "core/assert.h"

namespace marey::app {

/// What a worker made of one camera's frame: its picture's tags, say. Kept in places that
/// are used again and again, so that nothing is allocated once they are warm.
template <class Made>
struct LiveFrame {
  CameraId camera{};
  Timestamp time{0};
  const Made* made = nullptr;
};

/// Frames of one instant, as the workers made them. Valid until the next call.
template <class Made>
struct LiveGroup {
  std::int64_t number = 0;
  Timestamp time{0};
  std::vector<LiveFrame<Made>> frames;  ///< Ascending cameras.
  std::vector<CameraId> missing;
};

/// One worker for each camera: it fetches a frame, makes something of it, and offers that
/// to the others' (capture::FrameGrouper, live). The newest group wins; a camera that is
/// slow or dead keeps nobody waiting longer than the options say.
///
/// `Made` is default-constructible; `make` is called on the camera's own thread with the
/// frame and a place to write to, whose former content it may use up, and returns false
/// for a frame that is to be passed over, which no group waits for.
template <class Made>
class LiveGroups {
 public:
  using Make = std::function<bool(CameraId, const capture::RawFrame&, Made&)>;

  /// Feeds outlive it. Preconditions: those of FrameGrouper; a mode of kLive.
  LiveGroups(std::span<FrameFeed* const> feeds,
             std::span<const capture::ClockModel> clocks,
             const capture::GroupFramesOptions& options,
             Make make)
      : grouper_(clocks, options), make_(std::move(make)) {
    MAREY_ASSERT(options.mode == capture::GroupingMode::kLive);
    MAREY_ASSERT(feeds.size() == clocks.size());
    // Those kept until their group is made, one that is shown, one that is being made.
    const auto places = static_cast<std::size_t>(options.capacity) + 2;
    for (std::size_t c = 0; c < feeds.size(); ++c) {
      lanes_.push_back(std::make_unique<Lane>());
      for (std::size_t p = 0; p < places; ++p) {
        lanes_.back()->places.push_back(std::make_unique<Made>());
        lanes_.back()->free.push_back(static_cast<std::int64_t>(p));
      }
    }
    group_.frames.reserve(feeds.size());
    group_.missing.reserve(feeds.size());
    shown_.reserve(feeds.size());
    for (std::size_t c = 0; c < feeds.size(); ++c) {
      workers_.emplace_back([this, c, feed = feeds[c]](const std::stop_token& stop) {
        work(CameraId{static_cast<int>(c)}, *feed, stop);
      });
    }
  }

  /// The newest group once it is ready; null when none is within `timeout`.
  [[nodiscard]] const LiveGroup<Made>* next(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    give_back_shown();
    const auto give_up = Clock::now() + timeout;
    while (true) {
      if (const auto group = grouper_.next(monotonic_now())) return show(*group);
      auto until = give_up;
      if (const auto deadline = grouper_.deadline()) {
        until = std::min(until, Clock::time_point(*deadline) + kTick);
      }
      const bool is_over = ended_ == lanes_.size() && !grouper_.deadline();
      if (is_over || Clock::now() >= give_up) return nullptr;
      offered_.wait_until(lock, std::max(until, Clock::now() + kTick));
    }
  }

  /// Every feed has ended, and every group was handed out.
  [[nodiscard]] bool is_over() const {
    const std::lock_guard lock(mutex_);
    return ended_ == lanes_.size() && !grouper_.deadline();
  }

  [[nodiscard]] capture::GroupingCounts counts(CameraId camera) const {
    const std::lock_guard lock(mutex_);
    return grouper_.counts(camera);
  }

 private:
  /// CLOCK_MONOTONIC, as the cameras' own stamps.
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kTick{1};

  struct Lane {
    std::vector<std::unique_ptr<Made>> places;
    std::vector<std::int64_t> free;
  };

  void work(CameraId camera, FrameFeed& feed, const std::stop_token& stop) {
    constexpr std::chrono::milliseconds kListen{100};
    Lane& lane = *lanes_[index(camera)];
    while (!stop.stop_requested()) {
      const auto frame = feed.next(kListen);
      if (!frame && feed.is_over()) break;
      if (!frame) continue;
      std::int64_t place = 0;
      {
        const std::lock_guard lock(mutex_);
        MAREY_ASSERT(!lane.free.empty());
        place = lane.free.back();
        lane.free.pop_back();
      }
      const bool wanted =
          make_(camera, *frame, *lane.places[static_cast<std::size_t>(place)]);
      {
        const std::lock_guard lock(mutex_);
        if (!wanted) {
          lane.free.push_back(place);
          grouper_.pass_over(camera, frame->time);
        } else if (const capture::Offer offer = grouper_.offer(
                       camera, frame->time, capture::FrameTicket{place});
                   offer.dropped) {
          lane.free.push_back(static_cast<std::int64_t>(*offer.dropped));
        }
      }
      offered_.notify_one();
    }
    {
      const std::lock_guard lock(mutex_);
      grouper_.end(camera);
      ++ended_;
    }
    offered_.notify_one();
  }

  const LiveGroup<Made>* show(const capture::FrameGroup& group) {
    for (const capture::GroupedFrame& frame : group.surplus) {
      lanes_[index(frame.camera)]->free.push_back(
          static_cast<std::int64_t>(frame.ticket));
    }
    group_.number = group.number;
    group_.time = group.time;
    group_.frames.clear();
    group_.missing.assign(group.missing.begin(), group.missing.end());
    shown_.assign(group.frames.begin(), group.frames.end());
    for (const capture::GroupedFrame& frame : shown_) {
      const auto place = static_cast<std::size_t>(frame.ticket);
      group_.frames.push_back(
          {frame.camera, frame.time, lanes_[index(frame.camera)]->places[place].get()});
    }
    return &group_;
  }

  void give_back_shown() {
    for (const capture::GroupedFrame& frame : shown_) {
      lanes_[index(frame.camera)]->free.push_back(
          static_cast<std::int64_t>(frame.ticket));
    }
    shown_.clear();
  }

  mutable std::mutex mutex_;
  std::condition_variable offered_;
  capture::FrameGrouper grouper_;
  Make make_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::size_t ended_ = 0;  ///< Workers whose feed is over.
  LiveGroup<Made> group_;
  std::vector<capture::GroupedFrame> shown_;
  std::vector<std::jthread> workers_;  ///< Last: they end before what they use.
};

}  // namespace marey::app
