// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/find_soles.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "core/humanoid.h"
#include "core/pose.h"

namespace marey::retarget {
namespace {

// Marks the foot and its descendants.
std::vector<char> below(const Skeleton& skeleton, JointIndex foot) {
  std::vector<char> is_below(skeleton.joints.size(), 0);
  for (std::size_t j = 0; j < is_below.size(); ++j) {
    const auto& parent = skeleton.joints[j].parent;
    is_below[j] = j == index(foot) || (parent && is_below[index(*parent)]) ? 1 : 0;
  }
  return is_below;
}

}  // namespace

Soles find_soles(const Skeleton& skeleton,
                 const BodyMap& map,
                 std::span<const glm::dvec3> p_in_world,
                 std::span<const JointIndex> carrier) {
  MAREY_ASSERT(p_in_world.size() == carrier.size());
  MAREY_ASSERT(map.joints.size() == skeleton.joints.size());
  constexpr double kSoleInLegs = 0.1;
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  Soles soles;
  for (std::size_t side = 0; side < 2; ++side) {
    const FootMap& foot = map.feet[side];
    const JointIndex ankle = map.leg(static_cast<int>(side)).end;
    const RigidTransform& at = rest[index(ankle)];
    const glm::dquat t_pose_from_world =
        map.joints[index(ankle)].t_pose_from_joint * glm::conjugate(at.rotation);
    const std::vector<char> is_foot = below(skeleton, ankle);
    const auto toes =
        map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
    const std::vector<char> is_toes = toes ? below(skeleton, *toes) : std::vector<char>();
    bool toes_bend = false;
    const double floor_m = -foot.ankle_height_m;
    std::optional<glm::dvec3> heel;
    std::optional<glm::dvec3> tip;
    for (std::size_t i = 0; i < p_in_world.size(); ++i) {
      if (!is_foot[index(carrier[i])]) continue;
      toes_bend = toes_bend || (toes && is_toes[index(carrier[i])]);
      const glm::dvec3 p = t_pose_from_world * (p_in_world[i] - at.translation);
      if (p.y > floor_m + kSoleInLegs * map.leg_length_m) continue;
      if (!heel || p.z < heel->z) heel = p;
      if (!tip || p.z > tip->z) tip = p;
    }
    if (!heel) continue;
    const glm::dvec3 from_ball = *tip - foot.ball_from_ankle_in_t_pose;
    // Both ends are put on the floor: a round end that is a little above it at rest comes
    // down as the foot rolls.
    soles[side] = SoleEnds{{0.0, floor_m, std::min(heel->z, 0.0)},
                           {0.0, -foot.ball_height_m, std::max(from_ball.z, 0.0)},
                           toes_bend};
  }
  return soles;
}

void apply_soles(const Soles& soles, BodyMap& map) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!soles[side]) continue;
    map.feet[side].heel_from_ankle_in_t_pose = soles[side]->heel_from_ankle_in_t_pose;
    map.feet[side].tip_from_ball_in_t_pose = soles[side]->tip_from_ball_in_t_pose;
    map.feet[side].has_toes = map.feet[side].has_toes && soles[side]->toes_bend;
  }
}

}  // namespace marey::retarget
