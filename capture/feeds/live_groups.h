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

#include "capture/feeds/frame_feed.h"
#include "capture/sync/group_frames.h"
#include "core/base/assert.h"
#include "core/base/monotonic_clock.h"

namespace marey::capture {

/// The result of a worker for one camera's frame, such as the tags of its image. Its
/// storage is reused; nothing is allocated after the first frames.
template <class Made>
struct LiveFrame {
  CameraId camera{};
  Timestamp time{0};
  const Made* made = nullptr;
};

/// Results for the frames of one instant. Valid until the next call.
template <class Made>
struct LiveGroup {
  std::int64_t number = 0;
  Timestamp time{0};
  std::vector<LiveFrame<Made>> frames;  ///< Ascending cameras.
  std::vector<CameraId> missing;
};

/// Runs one worker per camera. Each fetches a frame, processes it, and passes the result
/// to the grouping of all cameras (FrameGrouper, live). Only the newest group is
/// returned. A slow or failed camera delays a group at most as long as the options allow.
///
/// `Made` is default-constructible. `make` is called on the camera's own thread with the
/// frame and a place for the result, whose former content it may reuse. It returns false
/// to skip a frame; no group waits for a skipped frame.
template <class Made>
class LiveGroups {
 public:
  using Make = std::function<bool(CameraId, const RawFrame&, Made&)>;

  /// Feeds must outlive it. Preconditions: those of FrameGrouper; the mode is kLive.
  LiveGroups(std::span<FrameFeed* const> feeds,
             std::span<const ClockModel> clocks,
             const GroupFramesOptions& options,
             Make make)
      : grouper_(clocks, options), make_(std::move(make)) {
    MAREY_ASSERT(options.mode == GroupingMode::kLive);
    MAREY_ASSERT(feeds.size() == clocks.size());
    // Results that wait for their group, one that is in use, and one that is written.
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

  /// Returns the newest group once it is ready; null if there is none within `timeout`.
  [[nodiscard]] const LiveGroup<Made>* next(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    release_shown();
    const auto wait_end = Clock::now() + timeout;
    while (true) {
      if (const auto group = grouper_.next(monotonic_now())) return show(*group);
      auto until = wait_end;
      if (const auto deadline = grouper_.deadline()) {
        until = std::min(until, Clock::time_point(*deadline) + kTick);
      }
      const bool is_over = ended_ == lanes_.size() && !grouper_.deadline();
      if (is_over || Clock::now() >= wait_end) return nullptr;
      offered_.wait_until(lock, std::max(until, Clock::now() + kTick));
    }
  }

  /// Returns true if every feed has ended and every group was returned.
  [[nodiscard]] bool is_over() const {
    const std::lock_guard lock(mutex_);
    return ended_ == lanes_.size() && !grouper_.deadline();
  }

  [[nodiscard]] GroupingCounts counts(CameraId camera) const {
    const std::lock_guard lock(mutex_);
    return grouper_.counts(camera);
  }

 private:
  /// CLOCK_MONOTONIC, like the cameras' time stamps.
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
        } else if (const Offer offer =
                       grouper_.offer(camera, frame->time, FrameTicket{place});
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

  const LiveGroup<Made>* show(const FrameGroup& group) {
    for (const GroupedFrame& frame : group.surplus) {
      lanes_[index(frame.camera)]->free.push_back(
          static_cast<std::int64_t>(frame.ticket));
    }
    group_.number = group.number;
    group_.time = group.time;
    group_.frames.clear();
    group_.missing.assign(group.missing.begin(), group.missing.end());
    shown_.assign(group.frames.begin(), group.frames.end());
    for (const GroupedFrame& frame : shown_) {
      const auto place = static_cast<std::size_t>(frame.ticket);
      group_.frames.push_back(
          {frame.camera, frame.time, lanes_[index(frame.camera)]->places[place].get()});
    }
    return &group_;
  }

  void release_shown() {
    for (const GroupedFrame& frame : shown_) {
      lanes_[index(frame.camera)]->free.push_back(
          static_cast<std::int64_t>(frame.ticket));
    }
    shown_.clear();
  }

  mutable std::mutex mutex_;
  std::condition_variable offered_;
  FrameGrouper grouper_;
  Make make_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::size_t ended_ = 0;  ///< Workers whose feed has ended.
  LiveGroup<Made> group_;
  std::vector<GroupedFrame> shown_;
  /// Last member: joined before the members that they use are destroyed.
  std::vector<std::jthread> workers_;
};

}  // namespace marey::capture
