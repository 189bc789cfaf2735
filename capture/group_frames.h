// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace marey::capture {

/// What a camera's clock makes of time. Common time, which all cameras share, is
/// camera_time * (1 + drift_ppm / 1e6) + offset.
struct ClockModel {
  Timestamp offset{0};
  double drift_ppm = 0.0;

  [[nodiscard]] Timestamp common_time(Timestamp camera_time) const;
};

enum class GroupingMode {
  /// The newest group wins: nobody is waited for longer than `longest_wait`, and what
  /// comes later, or was not fetched in time, is dropped and counted.
  kLive,
  /// Every frame comes out once, in the same groups for any order of arrivals between
  /// cameras. A camera is waited for until it delivers or end() is called.
  kOffline,
};

struct GroupFramesOptions {
  GroupingMode mode = GroupingMode::kOffline;
  /// Group k is of the instant origin + k / rate, common time.
  FrameRate rate{30.0};
  /// nullopt, live only: the time of the first frame offered.
  std::optional<Timestamp> origin = Timestamp{0};
  /// Live: a group is given up on the cameras that it lacks so long after its instant.
  std::chrono::nanoseconds longest_wait = std::chrono::milliseconds(50);
  /// Live: a camera without a frame for so long is not waited for until it is back.
  std::chrono::nanoseconds silent_after = std::chrono::milliseconds(500);
  /// Frames of one camera that are kept until their group is made.
  int capacity = 32;
};

/// The caller's own name for a frame: where its picture is.
enum class FrameTicket : std::int64_t {};

struct GroupedFrame {
  CameraId camera{};
  Timestamp time{0};  ///< Common time.
  FrameTicket ticket{};
};

/// Frames of one instant. Borrowed: valid until the next call to the grouper.
struct FrameGroup {
  std::int64_t number = 0;               ///< k. Groups without any frame are not made.
  Timestamp time{0};                     ///< The instant, common time.
  std::span<const GroupedFrame> frames;  ///< Ascending cameras, each at most once.
  std::span<const CameraId> missing;     ///< The other cameras, ascending.
  /// Frames in no group, for their tickets. Offline: a camera's second frame of this
  /// instant (its clock jumped, or it is faster than the rate). Live: those of groups
  /// that were skipped for this newer one.
  std::span<const GroupedFrame> surplus;
};

/// What became of an offered frame.
struct Offer {
  /// Offline: there is no room. Fetch groups, or offer other cameras' frames, and offer
  /// this one again. Live never lacks room.
  bool refused = false;
  /// Live: a frame that will be in no group, this one or an older one of its camera.
  std::optional<FrameTicket> dropped;
};

/// How a camera's frames fared. grouped + late + displaced + surplus + (those still kept)
/// == offered.
struct GroupingCounts {
  long offered = 0;    ///< Taken; refused offers do not count.
  long grouped = 0;    ///< In a group that was handed out.
  long late = 0;       ///< Live: their group was gone.
  long displaced = 0;  ///< Live: a newer frame of the camera took their place.
  long surplus = 0;    ///< Handed out as FrameGroup::surplus.
  long missing = 0;    ///< Groups that were handed out without this camera.
};

/// Puts together what cameras took at the same instant, on one grid of instants for all.
/// A frame belongs to the instant next to it; offline by its time alone. Live, where no
/// camera runs exactly at the rate nor in step with the grid, by its time less the
/// camera's own slowly followed lag, so that jitter around the middle between two
/// instants does not throw two frames of a camera into one group and none into the next.
///
/// Knows no thread and no clock: times are handed in. Allocates nothing after it was
/// made. Each camera's frames are offered in the order in which they were taken.
class FrameGrouper {
 public:
  /// Preconditions: a clock for each camera, 1 or more; positive rate; capacity >= 2;
  /// offline an origin.
  FrameGrouper(std::span<const ClockModel> clocks, const GroupFramesOptions& options);

  /// Hands a frame over. Precondition: end() was not called for the camera.
  Offer offer(CameraId camera, Timestamp camera_time, FrameTicket ticket);
  /// Live: this camera's frame of that time will not be offered, nor any before it: no
  /// group waits for it. Precondition: as offer().
  void pass_over(CameraId camera, Timestamp camera_time);
  /// No more frames will come from this camera.
  void end(CameraId camera);

  /// The next group that is ready: offline the oldest, live the newest; nullopt while
  /// there is none. `now` is common time; offline does not look at it.
  [[nodiscard]] std::optional<FrameGroup> next(Timestamp now = Timestamp{0});
  /// Live: when next() has a group at the latest, even if no other frame comes. nullopt
  /// while no frame is kept.
  [[nodiscard]] std::optional<Timestamp> deadline() const;

  [[nodiscard]] const GroupingCounts& counts(CameraId camera) const;
  /// Live: groups that had a frame and were skipped for a newer one.
  [[nodiscard]] long skipped_groups() const { return skipped_groups_; }

 private:
  struct Kept {
    std::int64_t slot = 0;
    Timestamp time{0};
    FrameTicket ticket{};
    bool surplus = false;
  };
  /// A camera and its queue, a ring of fixed size.
  struct Lane {
    ClockModel clock;
    std::vector<Kept> ring;
    std::size_t first = 0;
    std::size_t count = 0;
    std::int64_t last_slot = 0;
    Timestamp last_time{0};
    bool has_delivered = false;
    bool ended = false;
    double lag_ns = 0.0;  ///< Live: of its frames behind the grid.
    long followed = 0;
    GroupingCounts counts;

    [[nodiscard]] Kept& at(std::size_t i) { return ring[(first + i) % ring.size()]; }
    [[nodiscard]] const Kept& at(std::size_t i) const {
      return ring[(first + i) % ring.size()];
    }
    void push(const Kept& kept);
    void pop();
  };

  [[nodiscard]] std::int64_t slot_of(Lane& lane, Timestamp time) const;
  [[nodiscard]] std::int64_t follow(Lane& lane, Timestamp time) const;
  [[nodiscard]] Timestamp time_of(std::int64_t slot) const;
  [[nodiscard]] Offer keep_live(Lane& lane, const Kept& kept);
  [[nodiscard]] Offer keep_offline(Lane& lane, Kept kept);
  [[nodiscard]] std::optional<std::int64_t> oldest_slot() const;
  [[nodiscard]] bool is_waited_for(const Lane& lane, Timestamp now) const;
  [[nodiscard]] std::optional<std::int64_t> ready_offline() const;
  [[nodiscard]] std::optional<std::int64_t> ready_live(Timestamp now) const;
  [[nodiscard]] FrameGroup make_group(std::int64_t slot);
  void count_skipped(std::int64_t slot);

  GroupFramesOptions options_;
  double period_ns_ = 0.0;
  std::vector<Lane> lanes_;
  std::optional<Timestamp> first_time_;    ///< Of any frame.
  std::optional<std::int64_t> last_made_;  ///< Number of the last group.
  long skipped_groups_ = 0;
  // What the last group shows.
  std::vector<GroupedFrame> frames_;
  std::vector<GroupedFrame> surplus_;
  std::vector<CameraId> missing_;
};

}  // namespace marey::capture
