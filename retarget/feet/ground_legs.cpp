// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/ground_legs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/base/smooth_cover.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {

void add_legs(const Skeleton& body,
              const BodyMap& map,
              const NormalizedPose& pose,
              std::span<RigidTransform> world_from_joint,
              GroundLegs& out) {
  if (out.root.empty()) out.root_unit_m = root_unit_m(map, pose.root_normalization);
  Pose scratch;
  expand(pose, body, map, world_from_joint, scratch);
  const glm::dvec3 root = world_from_joint[index(map.hips())].translation;
  out.root.push_back(pose.root);
  for (int side = 0; side < 2; ++side) {
    LegPath& leg = out.legs[static_cast<std::size_t>(side)];
    leg.foot.push_back(foot_of(map, pose, world_from_joint, side));
    leg.hip_from_root.push_back(world_from_joint[index(map.leg(side).upper)].translation -
                                root);
    const auto& limb = pose.limbs[2 + static_cast<std::size_t>(side)];
    leg.extension.push_back(limb ? limb->extension : 1.0);
  }
}

std::vector<double> root_sinks_m(const BodyMap& map,
                                 const Contacts& contacts,
                                 FrameRate rate,
                                 const GroundLegs& ground,
                                 double anticipation_s,
                                 double straight) {
  const std::size_t count = ground.frame_count();
  MAREY_ASSERT(count > 0);
  std::vector<double> needed(count, 0.0);
  for (std::size_t side = 0; side < 2; ++side) {
    const LegPath& leg = ground.legs[side];
    const std::vector<char> bears = frame_marks(contacts.feet[side].stance, count);
    const double full_m = map.leg(static_cast<int>(side)).length_m();
    for (std::size_t t = 0; t < count; ++t) {
      if (!bears[t]) continue;
      const double length_m = full_m * std::max(straight, leg.extension[t]);
      // hip_from_root removes half the pelvis' width.
      const glm::dvec3 hip = ground.root[t] * ground.root_unit_m + leg.hip_from_root[t];
      needed[t] = std::max(needed[t], sink_m(hip, leg.foot[t].ankle_in_world, length_m));
    }
  }
  // A window longer than the whole motion has no further effect.
  const double half_frames =
      std::clamp(anticipation_s * 0.5 * rate.hz, 1.0, static_cast<double>(count));
  return smooth_cover(needed, static_cast<int>(std::lround(half_frames)));
}

std::array<double, 2> settle_pose(const BodyMap& map,
                                  const GroundLegs& ground,
                                  std::size_t frame,
                                  double sink_m,
                                  NormalizedPose& pose) {
  std::array<double, 2> missed_m{};
  pose.root.y -= sink_m / ground.root_unit_m;
  for (int side = 0; side < 2; ++side) {
    const LegPath& leg = ground.legs[static_cast<std::size_t>(side)];
    const glm::dvec3 hip = pose.root * ground.root_unit_m + leg.hip_from_root[frame];
    auto& limb = pose.limbs[2 + static_cast<std::size_t>(side)];
    MAREY_ASSERT(limb.has_value());
    missed_m[static_cast<std::size_t>(side)] =
        aim_leg(hip, leg.foot[frame].ankle_in_world, map.leg(side).length_m(), *limb);
    pose.segments[index(foot_bone(side))] = leg.foot[frame].foot;
    pose.segments[index(toes_bone(side))] = leg.foot[frame].toes;
  }
  return missed_m;
}

}  // namespace marey::retarget
