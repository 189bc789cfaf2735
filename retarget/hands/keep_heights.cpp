// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/keep_heights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/base/smooth_step.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

// Returns the vector from a limb's root to its end, rotated to the given height above the
// root at constant length. The steeper the vector, the less its horizontal direction is
// kept: an upright one has none.
glm::dvec3 turned_up(const glm::dvec3& from_root, double up_m) {
  constexpr double kMaxSine = 0.98;
  constexpr double kUpright = 0.1;
  const double length_m = std::max(glm::length(from_root), 1e-9);
  const double max_m = kMaxSine * length_m;
  const double y_m = std::clamp(up_m, -max_m, max_m);
  const double level_m = std::sqrt(length_m * length_m - y_m * y_m) /
                         std::hypot(from_root.x, from_root.z, kUpright * length_m);
  return {from_root.x * level_m, y_m, from_root.z * level_m};
}

// Returns the shift of a limb's end to a height; zero if it is there.
glm::dvec3 shift_to_height(const glm::dvec3& root,
                           const glm::dvec3& end,
                           double height_m) {
  const glm::dvec3 from_root = end - root;
  return turned_up(from_root, height_m - root.y) - turned_up(from_root, from_root.y);
}

}  // namespace

double kept_hips_height_m(double y_m, double source_stands_m, double avatar_stands_m) {
  constexpr double kLow = 0.3;
  const double low_m = kLow * std::min(source_stands_m, avatar_stands_m);
  if (y_m >= source_stands_m || low_m <= 0.0)
    return y_m + (avatar_stands_m - source_stands_m);
  if (y_m <= low_m) return y_m;
  // Cubic with slope 1 at both ends, or less to stay monotone (Fritsch and Carlson 1980,
  // "Monotone piecewise cubic interpolation").
  const double wide_m = source_stands_m - low_m;
  const double mean = (avatar_stands_m - low_m) / wide_m;
  const double slope = std::min(1.0, 3.0 * mean);
  const double u = (y_m - low_m) / wide_m;
  const double bend = u * (1.0 - u) * (1.0 - 2.0 * u);
  return low_m + wide_m * (mean * u * u * (3.0 - 2.0 * u) + slope * bend);
}

void keep_foot_heights(const Motion& source,
                       const BodyMap& source_map,
                       const std::array<double, 2>& rests_m,
                       const Skeleton& avatar,
                       const BodyMap& avatar_map,
                       double floor_m,
                       std::span<NormalizedPose> poses) {
  constexpr double kLow = 0.1;
  constexpr double kHigh = 0.6;
  MAREY_ASSERT(poses.size() == source.poses.size());
  std::vector<RigidTransform> source_world(source.skeleton.joints.size());
  std::vector<RigidTransform> avatar_world(avatar.joints.size());
  Pose scratch;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    world_from_joints(source.skeleton, source.poses[t], source_world);
    expand(poses[t], avatar, avatar_map, avatar_world, scratch);
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      const double up_m =
          source_world[index(source_map.leg(side).end)].translation.y - rests_m[s];
      const double share =
          smooth_step((up_m / source_map.leg_length_m - kLow) / (kHigh - kLow));
      if (share == 0.0) continue;
      const LimbMap& leg = avatar_map.leg(side);
      const glm::dvec3 hip = avatar_world[index(leg.upper)].translation;
      const glm::dvec3 ankle = avatar_world[index(leg.end)].translation;
      const glm::dvec3 shift =
          shift_to_height(hip, ankle, floor_m + avatar_map.feet[s].ankle_height_m + up_m);
      aim_leg(hip, ankle + share * shift, leg.length_m(), *poses[t].limbs[2 + s]);
    }
  }
}

void keep_hand_heights(const Arms& source,
                       double source_floor_m,
                       const Arms& avatar,
                       ArmShifts& shifts) {
  constexpr double kBent = 0.75;
  constexpr double kStretched = 0.92;
  constexpr double kHanging_rad = 0.87;  // 50 degrees.
  constexpr double kRaised_rad = 1.31;   // 75 degrees.
  MAREY_ASSERT(source.count() == avatar.count());
  for (int side = 0; side < 2; ++side) {
    if (!source.has(side) || !avatar.has(side)) continue;
    auto& shift = shifts[static_cast<std::size_t>(side)];
    for (std::size_t t = 0; t < source.count(); ++t) {
      const ArmPlaces from = source.places(t, side);
      const glm::dvec3 reach = from.wrist - from.shoulder;
      const double reach_m = std::max(glm::length(reach), 1e-9);
      const double raised_rad = std::acos(std::clamp(-reach.y / reach_m, -1.0, 1.0));
      const double share =
          smooth_step((reach_m / source.limb(side).length_m() - kBent) /
                      (kStretched - kBent)) *
          smooth_step((raised_rad - kHanging_rad) / (kRaised_rad - kHanging_rad));
      if (share == 0.0) continue;
      const ArmPlaces to = avatar.places(t, side);
      shift[t].wrist_m +=
          share * shift_to_height(to.shoulder, to.wrist, from.wrist.y - source_floor_m);
    }
  }
}

}  // namespace marey::retarget
