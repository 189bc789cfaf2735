// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/lead_legs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/feet/leg_reach.h"
#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

constexpr std::size_t kLeftLeg = kLimbRotation + 2;
constexpr std::size_t kLeftFoot = kSegmentRotation + 7;
constexpr std::size_t kLeftToes = kSegmentRotation + 9;
static_assert(kPostureSegments[7] == HumanBone::kLeftFoot);
static_assert(kPostureSegments[9] == HumanBone::kLeftToes);

glm::dquat rotation_of(const BlendPosture& posture, std::size_t i) {
  return {static_cast<double>(posture.w[i]),
          static_cast<double>(posture.x[i]),
          static_cast<double>(posture.y[i]),
          static_cast<double>(posture.z[i])};
}

void set_rotation(std::size_t i, const glm::dquat& rotation, BlendPosture& posture) {
  const glm::dquat q = glm::normalize(rotation);
  posture.w[i] = static_cast<float>(q.w);
  posture.x[i] = static_cast<float>(q.x);
  posture.y[i] = static_cast<float>(q.y);
  posture.z[i] = static_cast<float>(q.z);
}

// The least rotation between two unit vectors that are not opposite.
glm::dquat turn_between_directions(const glm::dvec3& from, const glm::dvec3& to) {
  return glm::normalize(glm::dquat(1.0 + glm::dot(from, to), glm::cross(from, to)));
}

glm::dquat heading_of(const RootPlace& root) {
  return glm::angleAxis(root.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
}

glm::dvec3 hip_in_world(const Rig& rig,
                        const RootPlace& root,
                        const BlendPosture& posture,
                        std::size_t side) {
  glm::dvec3 hip = rotation_of(posture, kSegmentRotation) * rig.hip_from_hips_legs[side];
  hip.y += static_cast<double>(posture.height_legs);
  return glm::dvec3(root.x_m, 0.0, root.z_m) +
         heading_of(root) * (rig.leg_length_m * hip);
}

void lead_leg(const Rig& rig,
              const RootPlace& root,
              std::size_t side,
              LedFoot& foot,
              BlendPosture& posture) {
  const double leg_m = rig.leg_length_m * rig.leg_legs[side];
  const glm::dvec3 hip = hip_in_world(rig, root, posture, side);
  const double away_m = glm::distance(hip, foot.ankle_in_world);
  const double free_m = leg_reach_m(away_m, leg_m);
  const double reach_m =
      free_m + foot.stands * (std::min(kMostReach * leg_m, away_m) - free_m);
  foot.ankle_in_world = ankle_within(hip, foot.ankle_in_world, reach_m);
  const glm::dquat heading_from_world = glm::conjugate(heading_of(root));
  const glm::dvec3 leg = heading_from_world * (foot.ankle_in_world - hip);
  const double distance_m = glm::length(leg);
  const std::size_t limb = kLeftLeg + side;
  const std::size_t value = 2 + side;
  if (distance_m > 1e-3 * leg_m) {
    const glm::dquat was = rotation_of(posture, limb);
    const glm::dvec3 axis = was * glm::dvec3(0.0, 0.0, 1.0);
    set_rotation(limb, turn_between_directions(axis, leg / distance_m) * was, posture);
    posture.fold_rad[value] =
        static_cast<float>(std::acos(std::min(distance_m / leg_m, 1.0)));
  }
  const glm::dquat foot_was = rotation_of(posture, kLeftFoot + side);
  const glm::dquat foot_is = heading_from_world * foot.world_from_t_pose;
  set_rotation(kLeftFoot + side, foot_is, posture);
  set_rotation(
      kLeftToes + side,
      foot_is * glm::conjugate(foot_was) * rotation_of(posture, kLeftToes + side),
      posture);
}

}  // namespace

std::array<LedFoot, 2> feet_of_posture(const Rig& rig,
                                       const RootPlace& root,
                                       const BlendPosture& posture) {
  const glm::dquat heading = heading_of(root);
  const FootPlaces places = foot_places(rig, posture);
  std::array<LedFoot, 2> out;
  for (std::size_t side = 0; side < 2; ++side) {
    glm::dvec3 ankle = places.ankle[side];
    ankle.y += static_cast<double>(posture.height_legs);
    out[side].ankle_in_world =
        glm::dvec3(root.x_m, 0.0, root.z_m) + heading * (rig.leg_length_m * ankle);
    out[side].world_from_t_pose =
        glm::normalize(heading * rotation_of(posture, kLeftFoot + side));
  }
  return out;
}

void lead_legs(const Rig& rig,
               const RootPlace& root,
               double drop_share,
               std::array<LedFoot, 2>& feet,
               BlendPosture& posture) {
  double drop_m = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    drop_m =
        std::max(drop_m,
                 feet[side].stands * hips_drop_m(hip_in_world(rig, root, posture, side),
                                                 feet[side].ankle_in_world,
                                                 rig.leg_length_m * rig.leg_legs[side]));
  }
  drop_m = drop_share * kMostHipsDrop_m * std::tanh(drop_m / kMostHipsDrop_m);
  posture.height_legs -= static_cast<float>(drop_m / rig.leg_length_m);
  for (std::size_t side = 0; side < 2; ++side) {
    lead_leg(rig, root, side, feet[side], posture);
  }
}

}  // namespace marey::engine
