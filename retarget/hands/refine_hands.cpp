// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/refine_hands.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/posed_frames.h"
#include "retarget/hands/keep_heights.h"

namespace marey::retarget {
namespace {

constexpr double kReachTolerance_m = 5e-3;

// Returns true if another touch of the same hand is nearer at that frame.
bool is_second(const Touches& touches, const Touch& touch, int frame) {
  return std::any_of(
      touches.touches.begin(), touches.touches.end(), [&](const Touch& other) {
        return &other != &touch && other.side == touch.side &&
               other.frames.first <= frame && other.frames.last >= frame &&
               other.distance_m < touch.distance_m;
      });
}

void measure_touches(const VolumeInMotion& source,
                     const VolumeInMotion& avatar,
                     const Arms& source_arms,
                     const Arms& arms,
                     const HandHolds& holds,
                     const ArmShifts& shifts,
                     HandReport& report) {
  const ArmShifts none{std::vector<ArmShift>(arms.count()),
                       std::vector<ArmShift>(arms.count())};
  double sum_m = 0.0;
  int frames = 0;
  for (const Touch& touch : report.touches.touches) {
    const VolumePart hand = on_side(VolumePart::kLeftHand, touch.side);
    if (!avatar.volume[hand] || !avatar.volume[touch.part]) continue;
    for (int frame = touch.frames.first; frame <= touch.frames.last; ++frame) {
      if (is_second(report.touches, touch, frame)) continue;
      const auto t = static_cast<std::size_t>(frame);
      const double error_m = std::abs(touch_gap_m(touch, avatar, arms, shifts, t) -
                                      touch_gap_m(touch, source, source_arms, none, t));
      report.worst_touch_error_m = std::max(report.worst_touch_error_m, error_m);
      sum_m += error_m;
      ++frames;
    }
  }
  if (frames > 0) report.mean_touch_error_m = sum_m / frames;
  for (std::size_t t = 0; t < arms.count(); ++t) {
    bool missed = false;
    for (int side = 0; side < 2; ++side) {
      const auto i = static_cast<std::size_t>(side);
      const bool holds_all = std::max(holds.hand[i][t], holds.hands[t]) >= 1.0;
      missed |= arms.has(side) && holds_all &&
                arms.out_of_reach_m(t, side, shifts[i][t]) > kReachTolerance_m;
    }
    if (missed) ++report.unreachable_frames;
  }
}

}  // namespace

HandReport refine_hands(const Motion& source,
                        const BodyMap& source_map,
                        const BodyMap& avatar_map,
                        const WorldScale& world,
                        const RefineHandsOptions& options,
                        Motion& motion) {
  MAREY_ASSERT(source.poses.size() == motion.poses.size());
  HandReport report;
  report.world = world;
  const std::size_t count = motion.poses.size();
  report.touches.frame_count = static_cast<int>(count);
  if (count == 0) return report;
  const BodyVolume source_volume = options.source_volume
                                       ? *options.source_volume
                                       : average_volume(source.skeleton, source_map);
  const BodyVolume avatar_volume = options.avatar_volume
                                       ? *options.avatar_volume
                                       : average_volume(motion.skeleton, avatar_map);
  const PosedFrames source_frames(source);
  const PosedFrames avatar_frames(motion);
  const VolumeInMotion from{source_frames, source_map, source_volume};
  const VolumeInMotion to{avatar_frames, avatar_map, avatar_volume};
  const Arms source_arms(source_frames, source_map);
  const Arms arms(avatar_frames, avatar_map);
  ArmShifts shifts{std::vector<ArmShift>(count), std::vector<ArmShift>(count)};
  if (world.keeps_heights) {
    keep_hand_heights(source_arms, world.source_floor_m, arms, shifts);
  }
  if (options.keep_touches) {
    report.touches = find_touches(source, source_map, source_volume, options.find);
  }
  const HandHolds holds = keep_touches(report.touches,
                                       from,
                                       to,
                                       arms,
                                       source.rate,
                                       world,
                                       options.keep,
                                       options.arms.slack_m,
                                       shifts);
  if (options.resolve_arm_collisions) {
    report.arms = resolve_arm_collisions(
        from, to, arms, source.rate, world, holds, options.arms, shifts);
  }
  measure_touches(from, to, source_arms, arms, holds, shifts, report);
  shift_arms(arms, avatar_map, avatar_frames, shifts, motion);
  return report;
}

}  // namespace marey::retarget
