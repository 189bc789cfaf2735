// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/group_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace marey::capture {
namespace {

CameraId camera_at(std::size_t lane) {
  return CameraId{static_cast<int>(lane)};
}

}  // namespace

Timestamp ClockModel::common_time(Timestamp camera_time) const {
  // The product is small: a double is accurate to the nanosecond.
  const double gained = static_cast<double>(camera_time.count()) * drift_ppm * 1e-6;
  return camera_time + Timestamp{std::llround(gained)} + offset;
}

void FrameGrouper::Lane::push(const Kept& kept) {
  MAREY_ASSERT(count < ring.size());
  ++count;
  at(count - 1) = kept;
}

void FrameGrouper::Lane::pop() {
  MAREY_ASSERT(count > 0);
  first = (first + 1) % ring.size();
  --count;
}

FrameGrouper::FrameGrouper(std::span<const ClockModel> clocks,
                           const GroupFramesOptions& options)
    : options_(options), period_ns_(1e9 / options.rate.hz), lanes_(clocks.size()) {
  MAREY_ASSERT(!clocks.empty());
  MAREY_ASSERT(options.rate.hz > 0.0);
  MAREY_ASSERT(options.capacity >= 2);
  MAREY_ASSERT(options.origin || options.mode == GroupingMode::kLive);
  const auto capacity = static_cast<std::size_t>(options.capacity);
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    lanes_[i].clock = clocks[i];
    lanes_[i].ring.resize(capacity);
  }
  frames_.reserve(clocks.size());
  missing_.reserve(clocks.size());
  surplus_.reserve(clocks.size() * capacity);
}

Offer FrameGrouper::offer(CameraId camera, Timestamp camera_time, FrameTicket ticket) {
  MAREY_ASSERT(index(camera) < lanes_.size());
  Lane& lane = lanes_[index(camera)];
  MAREY_ASSERT(!lane.ended);
  const Timestamp time = lane.clock.common_time(camera_time);
  const bool live = options_.mode == GroupingMode::kLive;
  if (!live && lane.count == lane.ring.size()) return {true, std::nullopt};
  if (!options_.origin) options_.origin = time;
  if (!first_time_) first_time_ = time;
  ++lane.counts.offered;
  const Kept kept{slot_of(lane, time), time, ticket};
  lane.last_time = time;
  const Offer offer = live ? keep_live(lane, kept) : keep_offline(lane, kept);
  lane.has_delivered = true;
  return offer;
}

void FrameGrouper::pass_over(CameraId camera, Timestamp camera_time) {
  MAREY_ASSERT(options_.mode == GroupingMode::kLive);
  MAREY_ASSERT(index(camera) < lanes_.size());
  Lane& lane = lanes_[index(camera)];
  MAREY_ASSERT(!lane.ended);
  if (!options_.origin) return;  // No frame was offered yet.
  const Timestamp time = lane.clock.common_time(camera_time);
  const std::int64_t slot = follow(lane, time);
  lane.last_slot = lane.has_delivered ? std::max(lane.last_slot, slot) : slot;
  lane.last_time = time;
  lane.has_delivered = true;
}

void FrameGrouper::end(CameraId camera) {
  MAREY_ASSERT(index(camera) < lanes_.size());
  lanes_[index(camera)].ended = true;
}

std::int64_t FrameGrouper::slot_of(Lane& lane, Timestamp time) const {
  if (options_.mode == GroupingMode::kLive) return follow(lane, time);
  return std::llround(static_cast<double>((time - *options_.origin).count()) /
                      period_ns_);
}

/// The lag is a moving average over the last frames, and a plain average at the start. It
/// may exceed half a period, up to the point where the next instant is clearly nearer.
std::int64_t FrameGrouper::follow(Lane& lane, Timestamp time) const {
  constexpr double kMinGain = 0.05;
  constexpr double kMaxLag_periods = 0.75;  // Periods.
  const auto since = static_cast<double>((time - *options_.origin).count());
  const std::int64_t slot = std::llround((since - lane.lag_ns) / period_ns_);
  const double lag_ns = since - static_cast<double>(slot) * period_ns_;
  ++lane.followed;
  const double gain = std::max(kMinGain, 1.0 / static_cast<double>(lane.followed));
  lane.lag_ns += gain * (lag_ns - lane.lag_ns);
  if (std::abs(lane.lag_ns) > kMaxLag_periods * period_ns_) {
    lane.lag_ns -= std::copysign(period_ns_, lane.lag_ns);
  }
  return slot;
}

Timestamp FrameGrouper::time_of(std::int64_t slot) const {
  return *options_.origin +
         Timestamp{std::llround(static_cast<double>(slot) * period_ns_)};
}

Offer FrameGrouper::keep_live(Lane& lane, const Kept& kept) {
  const bool behind = lane.count > 0 && kept.slot < lane.at(lane.count - 1).slot;
  if (behind || (last_made_ && kept.slot <= *last_made_)) {
    ++lane.counts.late;
    return {false, kept.ticket};
  }
  std::optional<FrameTicket> dropped;
  if (lane.count > 0 && lane.at(lane.count - 1).slot == kept.slot) {
    dropped = lane.at(lane.count - 1).ticket;
    --lane.count;
  } else if (lane.count == lane.ring.size()) {
    dropped = lane.at(0).ticket;
    lane.pop();
  }
  if (dropped) ++lane.counts.displaced;
  lane.last_slot = kept.slot;
  lane.push(kept);
  return {false, dropped};
}

Offer FrameGrouper::keep_offline(Lane& lane, Kept kept) {
  if (lane.has_delivered && kept.slot <= lane.last_slot) {
    kept.slot = lane.last_slot;
    kept.surplus = true;
  }
  lane.last_slot = kept.slot;
  lane.push(kept);
  return {};
}

std::optional<std::int64_t> FrameGrouper::oldest_slot() const {
  std::optional<std::int64_t> oldest;
  for (const Lane& lane : lanes_) {
    if (lane.count == 0) continue;
    oldest = std::min(oldest.value_or(lane.at(0).slot), lane.at(0).slot);
  }
  return oldest;
}

std::optional<std::int64_t> FrameGrouper::ready_offline() const {
  const std::optional<std::int64_t> oldest = oldest_slot();
  if (!oldest) return std::nullopt;
  for (const Lane& lane : lanes_) {
    if (lane.ended) continue;
    if (lane.count == 0 || lane.at(lane.count - 1).slot <= *oldest) return std::nullopt;
  }
  return oldest;
}

bool FrameGrouper::is_waited_for(const Lane& lane, Timestamp now) const {
  if (lane.ended || !first_time_) return false;
  const Timestamp last = lane.has_delivered ? lane.last_time : *first_time_;
  return now - last < options_.silent_after;
}

std::optional<std::int64_t> FrameGrouper::ready_live(Timestamp now) const {
  // The newest instant that every active camera has reached.
  std::int64_t common = std::numeric_limits<std::int64_t>::max();
  for (const Lane& lane : lanes_) {
    if (!is_waited_for(lane, now)) continue;
    common = lane.has_delivered ? std::min(common, lane.last_slot)
                                : std::numeric_limits<std::int64_t>::min();
  }
  std::optional<std::int64_t> newest;
  for (const Lane& lane : lanes_) {
    for (std::size_t i = 0; i < lane.count; ++i) {
      const std::int64_t slot = lane.at(i).slot;
      if (slot > common && now < time_of(slot) + options_.max_wait) continue;
      if (!newest || slot > *newest) newest = slot;
    }
  }
  return newest;
}

std::optional<FrameGroup> FrameGrouper::next(Timestamp now) {
  const auto slot =
      options_.mode == GroupingMode::kLive ? ready_live(now) : ready_offline();
  if (!slot) return std::nullopt;
  return make_group(*slot);
}

void FrameGrouper::count_skipped(std::int64_t slot) {
  // Lanes are ordered: visit the instants before `slot` upwards.
  std::optional<std::int64_t> at;
  while (true) {
    std::optional<std::int64_t> above;
    for (const Lane& lane : lanes_) {
      for (std::size_t i = 0; i < lane.count; ++i) {
        const std::int64_t other = lane.at(i).slot;
        if (other >= slot || (at && other <= *at)) continue;
        above = std::min(above.value_or(other), other);
        break;
      }
    }
    if (!above) return;
    ++skipped_groups_;
    at = above;
  }
}

FrameGroup FrameGrouper::make_group(std::int64_t slot) {
  frames_.clear();
  missing_.clear();
  surplus_.clear();
  count_skipped(slot);
  for (std::size_t c = 0; c < lanes_.size(); ++c) {
    Lane& lane = lanes_[c];
    bool found = false;
    while (lane.count > 0 && lane.at(0).slot <= slot) {
      const Kept& kept = lane.at(0);
      const GroupedFrame frame{camera_at(c), kept.time, kept.ticket};
      if (kept.slot == slot && !kept.surplus) {
        frames_.push_back(frame);
        found = true;
        ++lane.counts.grouped;
      } else {
        surplus_.push_back(frame);
        ++lane.counts.surplus;
      }
      lane.pop();
    }
    if (found) continue;
    missing_.push_back(camera_at(c));
    ++lane.counts.missing;
  }
  last_made_ = slot;
  return {slot, time_of(slot), frames_, missing_, surplus_};
}

std::optional<Timestamp> FrameGrouper::deadline() const {
  const std::optional<std::int64_t> oldest = oldest_slot();
  if (!oldest) return std::nullopt;
  return time_of(*oldest) + options_.max_wait;
}

const GroupingCounts& FrameGrouper::counts(CameraId camera) const {
  MAREY_ASSERT(index(camera) < lanes_.size());
  return lanes_[index(camera)].counts;
}

}  // namespace marey::capture
