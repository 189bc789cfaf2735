// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/touch_constraints.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/base/assert.h"
#include "core/base/frame_range.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

BodyPoint body_point(const Skeleton& body,
                     const BodyMap& map,
                     JointIndex joint,
                     const glm::dvec3& p_in_joint) {
  const Joint& at = body[joint];
  // A joint without a mark has no portable T-pose; parts of a volume are not attached to
  // it.
  return {at.bone ? std::string(name(*at.bone)) : at.name,
          map.joints[index(joint)].t_pose_from_joint * p_in_joint};
}

// Returns true if the same hand touches something nearer at that time.
bool is_second(const Touches& touches, const Touch& touch) {
  return std::any_of(
      touches.touches.begin(), touches.touches.end(), [&](const Touch& other) {
        return &other != &touch && other.side == touch.side &&
               other.frames.first <= touch.frames.last &&
               other.frames.last >= touch.frames.first &&
               other.distance_m < touch.distance_m;
      });
}

}  // namespace

Activation fading(const FrameRange& frames,
                  int frame_count,
                  int first_frame,
                  FrameRate rate,
                  double fade_s) {
  Activation when;
  when.start_duration_s = fade_s;
  when.stop_duration_s = fade_s;
  if (frames.first > 0) when.start_s = (first_frame + frames.first) / rate.hz - fade_s;
  if (frames.last + 1 < frame_count) when.stop_s = (first_frame + frames.last) / rate.hz;
  return when;
}

ConstraintSet constraints_of(const Touches& touches,
                             const Skeleton& body,
                             const BodyMap& map,
                             const BodyVolume& volume,
                             int first_frame,
                             FrameRate rate,
                             const TouchConstraintsOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0);
  ConstraintSet set;
  std::map<std::string, int> used;
  const auto add = [&](const Capsule& hand,
                       double along_hand,
                       Goal goal,
                       const std::string& words,
                       const FrameRange& frames) {
    Constraint constraint;
    constraint.id = words + " " + std::to_string(++used[words]);
    constraint.point =
        body_point(body, map, hand.joint, axis_point_in_joint(hand, along_hand));
    constraint.goal = std::move(goal);
    constraint.precision_m = options.precision_m;
    constraint.activation =
        fading(frames, touches.frame_count, first_frame, rate, options.fade_s);
    set.constraints.push_back(std::move(constraint));
  };
  for (const Touch& touch : touches.touches) {
    const P side = on_side(P::kLeftHand, touch.side);
    const auto& hand = volume[side];
    const auto& part = volume[touch.part];
    if (!hand || !part) continue;
    if (options.nearest_alone && is_second(touches, touch)) continue;
    const DistanceToBody goal{
        std::max(hand->radius_m + touch.distance_m, 0.0),
        body_point(body, map, part->joint, surface_point_in_joint(*part, touch.place))};
    add(*hand,
        touch.along_hand,
        goal,
        std::string(name(side)) + " on " + std::string(name(touch.part)),
        touch.frames);
  }
  if (options.still == StillPlace::kFree) return set;
  for (const StillHand& still : touches.still) {
    const P side = on_side(P::kLeftHand, still.side);
    if (!volume[side]) continue;
    add(*volume[side],
        0.0,
        DistanceToPoint{0.0, options.world.of(still.p_in_world, options.still)},
        std::string(name(side)) + " still",
        still.frames);
  }
  return set;
}

}  // namespace marey::retarget
