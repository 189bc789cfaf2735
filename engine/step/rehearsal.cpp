// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/rehearsal.h"

#include <algorithm>
#include <cmath>

#include "engine/clips/sample_clip.h"
#include "engine/feet/lead_legs.h"

#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::engine {

Rehearsal::Rehearsal(const Skeleton& skeleton, const retarget::BodyMap& map)
    : skeleton_(&skeleton),
      map_(&map),
      joints_(skeleton.joints.size()),
      led_joints_(skeleton.joints.size()),
      rig_(make_rig(skeleton, map)) {
  pose_.parent_from_joint.resize(skeleton.joints.size());
  adapted_.parent_from_joint.resize(skeleton.joints.size());
}

bool Rehearsal::predict(double now_s, double time_s, const BlendPlayer& blend) {
  if (!blend.predict(now_s, time_s, posture_, root_)) return false;
  layout_ = blend.base().layout();
  to_normalized(posture_, blend.base().layout(), root_, map_->leg_length_m, normalized_);
  retarget::expand(normalized_, *skeleton_, *map_, joints_, pose_);
  return true;
}

void Rehearsal::sample(double source_s,
                       const MotionClip& clip,
                       const PostureLayout& layout) {
  BlendPosture posture;
  sample_clip(clip, source_s, posture);
  root_ = relative(path_at(clip, 0.0), path_at(clip, source_s));
  root_.x_m *= map_->leg_length_m;
  root_.z_m *= map_->leg_length_m;
  to_normalized(posture, layout, root_, map_->leg_length_m, normalized_);
  retarget::expand(normalized_, *skeleton_, *map_, joints_, pose_);
}

std::span<const RigidTransform> Rehearsal::adapt(
    double time_s,
    const BodyShift& shift,
    std::span<std::optional<retarget::Adapter::Handle>> supports,
    retarget::Adapter& adapter) {
  std::array<LedFoot, 2> led = feet_of_posture(rig_, root_, posture_);
  for (std::size_t side = 0; side < 2; ++side) {
    const StandingFoot& foot = shift.feet[side];
    if (foot.stands) {
      led[side] = {foot.ankle_in_world, foot.world_from_t_pose, 1.0};
    } else {
      led[side].ankle_in_world += foot.from_reference_m;
    }
  }
  BlendPosture posture = posture_;
  lead_legs(rig_, root_, 1.0, led, posture);
  to_normalized(posture, layout_, root_, map_->leg_length_m, normalized_);
  retarget::expand(normalized_, *skeleton_, *map_, led_joints_, pose_);
  for (std::size_t side = 0; side < 2; ++side) {
    supports[side]->set_target(led[side].ankle_in_world);
    supports[side]->set_orientation(led[side].world_from_t_pose);
  }
  (void)adapter.adapt(pose_, time_s, adapted_);
  return adapter.world_from_joint();
}

RootPlace posed_root(std::span<const RigidTransform> world_from_joint,
                     const retarget::BodyMap& map) {
  const glm::dvec3 hips = world_from_joint[index(map.hips())].translation;
  const glm::dquat turn =
      retarget::rotation_from_t_pose(map, world_from_joint, map.hips());
  return {hips.x, hips.z, 2.0 * std::atan2(turn.y, turn.w)};
}

RigidTransform posed_wrist(std::span<const RigidTransform> world_from_joint,
                           const retarget::BodyMap& map,
                           int side) {
  const JointIndex hand = map.limbs[static_cast<std::size_t>(side)]->end;
  return {retarget::rotation_from_t_pose(map, world_from_joint, hand),
          world_from_joint[index(hand)].translation};
}

double event_time_s(const PhaseWarp& warp, double now_s, double event_s) {
  if (warp.source_s(now_s) >= event_s) return now_s;
  double low = now_s;
  double high = now_s + (event_s - warp.source_s(now_s)) / kMinWarpRate;
  for (int i = 0; i < 44; ++i) {
    const double middle = 0.5 * (low + high);
    (warp.source_s(middle) < event_s ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace marey::engine
