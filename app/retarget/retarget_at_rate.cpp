// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/retarget_at_rate.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/frame_range.h"
#include "core/resample.h"
#include "retarget/body/find_soles.h"
#include "retarget/motion/live_retarget.h"

namespace marey::app {
namespace {

using retarget::RetargetedMotion;

Result<RetargetedMotion> retarget_live(const Motion& source,
                                       const Skeleton& avatar,
                                       const retarget::RetargetOptions& options) {
  // Contacts, and the figures `before` the ground, are computed as for whole motions.
  retarget::RetargetOptions free = options;
  free.adapt_ground = false;
  free.hands.reset();
  auto out = retarget::retarget_motion(source, avatar, free);
  if (!out) return out.error();
  retarget::LiveRetargetOptions live;
  live.root = options.root;
  live.hold_feet = options.adapt_ground;
  live.stance.contacts = options.contacts;
  live.soles = options.soles;
  if (options.skin != nullptr) live.skin = *options.skin;
  if (options.hands) {
    live.hands->source_volume = options.hands->source_volume;
    live.hands->avatar_volume = options.hands->avatar_volume;
  } else {
    live.hands.reset();
  }
  auto stage = retarget::LiveRetarget::make(source.skeleton, avatar, live);
  if (!stage) return stage.error();
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    stage->step(source.poses[t], 1.0 / source.rate.hz, out->motion.poses[t]);
  }
  auto map = retarget::map_body(avatar);
  if (!map) return map.error();
  retarget::apply_soles(options.soles, *map);
  out->report.after = retarget::measure_feet(out->motion, *map, out->report.contacts);
  return out;
}

/// The frames kept from a motion at `multiple` times the output rate.
struct Kept {
  int multiple = 1;
  int before = 0;  ///< Number of frames before the first kept one.
  int count = 0;
};

std::vector<FrameRange> kept_of(const std::vector<FrameRange>& runs, const Kept& kept) {
  std::vector<FrameRange> out;
  for (const FrameRange& run : runs) {
    // First frame that is not earlier, last frame that is not later.
    const int first =
        std::max(0, (run.first - kept.before + kept.multiple - 1) / kept.multiple);
    if (run.last < kept.before) continue;
    const int last = std::min(kept.count - 1, (run.last - kept.before) / kept.multiple);
    if (first <= last) out.push_back({first, last});
  }
  return out;
}

Contacts kept_of(const Contacts& contacts, const Kept& kept) {
  Contacts out = contacts;
  out.frame_count = kept.count;
  for (FootContacts& foot : out.feet) {
    foot.heel = kept_of(foot.heel, kept);
    foot.ball = kept_of(foot.ball, kept);
    foot.stance = kept_of(foot.stance, kept);
    foot.heel_up = kept_of(foot.heel_up, kept);
  }
  return out;
}

// Drops touches without a kept frame.
template <class Found>
std::vector<Found> kept_of(const std::vector<Found>& all, const Kept& kept) {
  std::vector<Found> out;
  for (Found one : all) {
    const auto frames = kept_of(std::vector<FrameRange>{one.frames}, kept);
    if (frames.empty()) continue;
    one.frames = frames.front();
    out.push_back(one);
  }
  return out;
}

retarget::Touches kept_of(const retarget::Touches& touches, const Kept& kept) {
  return {kept.count, kept_of(touches.touches, kept), kept_of(touches.still, kept)};
}

Result<RetargetedMotion> put_on_as_it_is(const Motion& source,
                                         const Skeleton& avatar,
                                         const RetargetAtRateOptions& options) {
  return options.live ? retarget_live(source, avatar, options.retarget)
                      : retarget::retarget_motion(source, avatar, options.retarget);
}

}  // namespace

Result<RetargetedMotion> retarget_at_rate(const Motion& source,
                                          const Skeleton& avatar,
                                          const RetargetAtRateOptions& options) {
  if (!options.rate_hz || *options.rate_hz == source.rate.hz) {
    return put_on_as_it_is(source, avatar, options);
  }
  const FrameRate rate{*options.rate_hz};
  Kept kept;
  kept.multiple = std::max(1, static_cast<int>(std::ceil(source.rate.hz / rate.hz)));
  auto out = put_on_as_it_is(
      resample(source, FrameRate{kept.multiple * rate.hz}), avatar, options);
  if (!out) return out;
  const int dense_first = out->motion.first_frame;
  if (kept.multiple > 1) out->motion = resample(out->motion, rate);
  if (out->motion.poses.empty()) {
    return bad_input(
        "", "the motion is shorter than a frame at that rate", "give a higher --rate");
  }
  if (kept.multiple == 1) return out;
  kept.before = kept.multiple * out->motion.first_frame - dense_first;
  kept.count = static_cast<int>(out->motion.poses.size());
  out->report.contacts = kept_of(out->report.contacts, kept);
  out->report.hands.touches = kept_of(out->report.hands.touches, kept);
  std::vector<double> depth_m;
  for (int t = 0; t < kept.count; ++t) {
    const auto dense = static_cast<std::size_t>(kept.before + kept.multiple * t);
    depth_m.push_back(out->report.source_depth_m[dense]);
  }
  out->report.source_depth_m = std::move(depth_m);
  auto map = retarget::map_body(avatar);
  if (!map) return map.error();
  retarget::apply_soles(options.retarget.soles, *map);
  // The figures `before` refer to all frames, because that motion was not kept.
  out->report.after = retarget::measure_feet(out->motion, *map, out->report.contacts);
  return out;
}

}  // namespace marey::app
