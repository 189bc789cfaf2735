// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/time.h"

namespace marey::capture {

/// Conversion of a camera's clock to the common time of all cameras: camera_time * (1 +
/// drift_ppm / 1e6) + offset.
struct ClockModel {
  Timestamp offset{0};
  double drift_ppm = 0.0;

  [[nodiscard]] Timestamp common_time(Timestamp camera_time) const;
};

enum class GroupingMode {
  /// Only the newest group is returned. A group waits for a camera at most
  /// `max_wait`; frames that arrive later, or were not fetched in time, are dropped
  /// and counted.
  kLive,
  /// Every frame is returned once, in groups that do not depend on the order of arrivals
  /// between cameras. A group waits for a camera until it delivers or end() is called.
  kOffline,
};

/// Waiting time of live work for the frames of missing cameras.
inline constexpr std::chrono::nanoseconds kMaxGroupWait = std::chrono::milliseconds(50);

struct GroupFramesOptions {
  GroupingMode mode = GroupingMode::kOffline;
  /// Group k has the instant origin + k / rate, in common time.
  FrameRate rate{30.0};
  /// nullopt, live only: the time of the first frame offered.
  std::optional<Timestamp> origin = Timestamp{0};
  /// Live: waiting time for missing cameras after a group's instant.
  std::chrono::nanoseconds max_wait = kMaxGroupWait;
  /// Live: a camera without a frame for this time is not waited for until its next frame.
  std::chrono::nanoseconds silent_after = std::chrono::milliseconds(500);
  /// Maximum number of frames of one camera that wait for their group.
  int capacity = 32;
};

/// The caller's identifier of a frame, such as the index of its buffer.
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
  /// Frames in no group, so that the caller can release them. Offline: a camera's second
  /// frame of this instant (its clock jumped, or it is faster than the rate). Live:
  /// frames of groups that were skipped for this newer one.
  std::span<const GroupedFrame> surplus;
};

/// Result of an offered frame.
struct Offer {
  /// Offline: the queue is full. Fetch groups, or offer other cameras' frames, then offer
  /// this frame again. Never set in live mode.
  bool refused = false;
  /// Live: a frame that will be in no group; either this one or an older one of its
  /// camera.
  std::optional<FrameTicket> dropped;
};

/// Counts of a camera's frames. grouped + late + displaced + surplus + (frames in the
/// queue) == offered.
struct GroupingCounts {
  long offered = 0;    ///< Accepted frames; refused offers do not count.
  long grouped = 0;    ///< In a returned group.
  long late = 0;       ///< Live: their group was already finished.
  long displaced = 0;  ///< Live: replaced by a newer frame of the camera.
  long surplus = 0;    ///< Returned as FrameGroup::surplus.
  long missing = 0;    ///< Groups that were returned without this camera.
};

/// Groups frames that cameras took at the same instant, on one grid of instants for all.
/// A frame belongs to the nearest instant. Offline mode uses its time alone. In live
/// mode, no camera runs exactly at the rate or in phase with the grid; the camera's own
/// slowly filtered lag is therefore subtracted. Jitter around the midpoint of two
/// instants then does not put two frames of a camera into one group and none into the
/// next.
///
/// Independent of threads and clocks: times are arguments. Allocates nothing after the
/// construction. Each camera's frames are offered in the order of their exposure.
class FrameGrouper {
 public:
  /// Preconditions: a clock for each camera, 1 or more; positive rate; capacity >= 2; an
  /// origin in offline mode.
  FrameGrouper(std::span<const ClockModel> clocks, const GroupFramesOptions& options);

  /// Adds a frame. Precondition: end() was not called for the camera.
  Offer offer(CameraId camera, Timestamp camera_time, FrameTicket ticket);
  /// Live: this camera's frame of that time will not be offered, and neither will any
  /// before it: no group waits for it. Precondition: as for offer().
  void pass_over(CameraId camera, Timestamp camera_time);
  /// Declares that no more frames will come from this camera.
  void end(CameraId camera);

  /// Returns the next group that is ready: offline the oldest, live the newest; nullopt
  /// if there is none. `now` is in common time; ignored in offline mode.
  [[nodiscard]] std::optional<FrameGroup> next(Timestamp now = Timestamp{0});
  /// Live: latest time at which next() has a group, even if no other frame arrives.
  /// nullopt if no frame is in the queue.
  [[nodiscard]] std::optional<Timestamp> deadline() const;

  [[nodiscard]] const GroupingCounts& counts(CameraId camera) const;
  /// Live: number of groups that had a frame and were skipped for a newer one.
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
    double lag_ns = 0.0;  ///< Live: mean delay of its frames relative to the grid.
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
  std::optional<Timestamp> first_time_;    ///< Over all cameras.
  std::optional<std::int64_t> last_made_;  ///< Number of the last group.
  long skipped_groups_ = 0;
  // Content of the last group.
  std::vector<GroupedFrame> frames_;
  std::vector<GroupedFrame> surplus_;
  std::vector<CameraId> missing_;
};

}  // namespace marey::capture
