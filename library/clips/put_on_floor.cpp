// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/clips/put_on_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/degrees.h"
#include "core/base/quantile.h"
#include "core/human/centre_of_mass.h"
#include "core/skeleton.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::library {
namespace {

constexpr double kFloorShare = 0.05;
// Maximum rise of the ball over the ankle, more than that of a standing foot. A foot that
// lands on its heel has less, the feet of a body that lies on its back have more.
constexpr double kMaxRise_rad = 40.0 * kRadiansPerDegree;
constexpr double kHalfGravity_m_s2 = 0.5 * 9.81;
constexpr double kHalfSpan_s = 0.1;
constexpr double kNoHeight_m = std::numeric_limits<double>::max();

// Heights of one foot in one frame.
struct FootHeights {
  double sole_m = 0.0;
  double joint_m = 0.0;    // The lower one of ankle and ball.
  bool may_stand = false;  // Below the hips, and does not point up.
};

double rise_rad(const glm::dvec3& along) {
  return std::atan2(along.y, std::hypot(along.x, along.z));
}

FootHeights heights_of_foot(const retarget::BodyMap& map,
                            std::span<const RigidTransform> world,
                            int side) {
  const retarget::FootMap& foot = map.feet[static_cast<std::size_t>(side)];
  const JointIndex joint = map.leg(side).end;
  const RigidTransform& ankle = world[index(joint)];
  const auto toes =
      map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
  glm::dvec3 along = ankle.rotation *
                     glm::conjugate(map.joints[index(joint)].t_pose_from_joint) *
                     foot.ball_from_ankle_in_t_pose;
  if (toes) along = world[index(*toes)].translation - ankle.translation;
  const double ball_y = ankle.translation.y + along.y;
  FootHeights out;
  out.sole_m =
      std::min(ankle.translation.y - foot.ankle_height_m, ball_y - foot.ball_height_m);
  out.joint_m = std::min(ankle.translation.y, ball_y);
  out.may_stand =
      rise_rad(along) - rise_rad(foot.ball_from_ankle_in_t_pose) < kMaxRise_rad &&
      ankle.translation.y < world[index(map.hips())].translation.y;
  return out;
}

std::array<std::vector<char>, 2> standing_frames(const Motion& motion,
                                                 const retarget::BodyMap& map) {
  const Contacts contacts = retarget::detect_contacts(motion, map);
  std::array<std::vector<char>, 2> out;
  for (std::size_t side = 0; side < out.size(); ++side) {
    out[side].assign(motion.poses.size(), 0);
    for (const FrameRange& stance : contacts.feet[side].stance) {
      for (int t = stance.first; t <= stance.last; ++t) {
        out[side][static_cast<std::size_t>(t)] = 1;
      }
    }
  }
  return out;
}

// 1 for every frame in which something supports the body. A frame near an end is like the
// first or last one that has a whole span around it.
std::vector<char> supported_frames(const Motion& motion, const retarget::BodyMap& map) {
  const auto masses = retarget::place_masses(motion.skeleton, map, {});
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<double> mass_m;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    mass_m.push_back(masses ? centre_of_mass(*masses, world).y
                            : world[index(map.hips())].translation.y);
  }
  const auto half =
      static_cast<std::size_t>(std::max(1.0, std::round(kHalfSpan_s * motion.rate.hz)));
  const double span_s = static_cast<double>(half) / motion.rate.hz;
  std::vector<char> out(mass_m.size(), 1);
  if (mass_m.size() < 2 * half + 1) return out;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::size_t middle = std::clamp(t, half, out.size() - 1 - half);
    const double bend_m =
        mass_m[middle - half] - 2.0 * mass_m[middle] + mass_m[middle + half];
    out[t] = bend_m > -kHalfGravity_m_s2 * span_s * span_s ? 1 : 0;
  }
  return out;
}

std::vector<double> soles_that_bear_m(const Motion& motion,
                                      const retarget::BodyMap& map,
                                      const std::vector<char>& supported) {
  const auto stands = standing_frames(motion, map);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<double> out;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    if (supported[t] == 0 || (stands[0][t] == 0 && stands[1][t] == 0)) continue;
    world_from_joints(motion.skeleton, motion.poses[t], world);
    double lower_m = kNoHeight_m;
    for (int side = 0; side < 2; ++side) {
      if (stands[static_cast<std::size_t>(side)][t] == 0) continue;
      const FootHeights foot = heights_of_foot(map, world, side);
      if (foot.may_stand) lower_m = std::min(lower_m, foot.sole_m);
    }
    if (lower_m < kNoHeight_m) out.push_back(lower_m);
  }
  return out;
}

// Lowest point of the body's surface.
double lowest_surface_m(const retarget::BodyMap& map,
                        const retarget::BodyVolume& volume,
                        std::span<const RigidTransform> world) {
  double lowest_m = kNoHeight_m;
  for (std::size_t part = 0; part < volume.parts.size(); ++part) {
    const auto& capsule = volume.parts[part];
    if (!capsule) continue;
    for (const double end : {-1.0, 1.0}) {
      // Below the ankle is the foot.
      const bool is_shank = part == index(retarget::VolumePart::kLeftShank) ||
                            part == index(retarget::VolumePart::kRightShank);
      if (is_shank && end > 0.0) continue;
      const glm::dvec3 p =
          world[index(capsule->joint)] * retarget::axis_point_in_joint(*capsule, end);
      lowest_m = std::min(lowest_m, p.y - capsule->radius_m);
    }
  }
  for (int side = 0; side < 2; ++side) {
    const FootHeights foot = heights_of_foot(map, world, side);
    lowest_m = std::min(lowest_m, foot.may_stand ? foot.sole_m : foot.joint_m);
  }
  return lowest_m;
}

std::vector<double> supported_surfaces_m(const Motion& motion,
                                         const retarget::BodyMap& map,
                                         const std::vector<char>& supported) {
  const retarget::BodyVolume volume = retarget::average_volume(motion.skeleton, map);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<double> out;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    if (supported[t] == 0) continue;
    world_from_joints(motion.skeleton, motion.poses[t], world);
    out.push_back(lowest_surface_m(map, volume, world));
  }
  return out;
}

}  // namespace

std::optional<double> floor_height_m(const Motion& motion, const retarget::BodyMap& map) {
  const std::vector<char> supported = supported_frames(motion, map);
  std::vector<double> heights_m = soles_that_bear_m(motion, map, supported);
  if (heights_m.empty()) heights_m = supported_surfaces_m(motion, map, supported);
  if (heights_m.empty()) return std::nullopt;
  return quantile(std::move(heights_m), kFloorShare);
}

double put_on_floor(Motion& motion, const retarget::BodyMap& map) {
  const double shift_m = 0.0 - floor_height_m(motion, map).value_or(0.0);
  for (Pose& pose : motion.poses) pose.root_in_world.y += shift_m;
  return shift_m;
}

}  // namespace marey::library
