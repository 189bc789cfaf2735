// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_volume.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/assert.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

// Ratios of the average adult, see the header; the last digit corresponds to a
// centimetre.
constexpr double kUpperArmRadius = 0.156;  // Circumference 31 cm, length 31.5 cm.
constexpr double kForearmRadius = 0.146;   // 29 cm at the elbow to 16.5 cm, of 24.7 cm.
constexpr double kHandRadius = 0.11;       // 8.5 cm by 2.8 cm, of 18.3 cm.
constexpr double kThighRadius = 0.194;     // 62 cm to 39 cm, of 41.5 cm.
constexpr double kShankRadius = 0.115;     // 38 cm to 22 cm, of 41.6 cm.
constexpr double kHeadRadius = 0.43;       // 15 cm by 19.5 cm, joint to vertex 20 cm.
constexpr double kHeadStart = 0.35;        // Share of the head's height: the lower ball.

// One slice of the trunk.
struct TrunkSlice {
  P part;
  double height;           // Its middle, from the hip joints to the base of the neck.
  double shoulders_share;  // Breadth between shoulders and between hips, mixed.
  double breadth;          // Over that.
  double depth;            // Over the height of the trunk.
};
constexpr std::array<TrunkSlice, 3> kTrunkSlices{{
    {P::kPelvis, 0.12, 0.0, 1.96, 0.475},
    {P::kAbdomen, 0.40, 0.5, 1.18, 0.45},
    {P::kChest, 0.70, 1.0, 0.78, 0.49},
}};

// Lengths that a skeleton may lack, in leg lengths, after average_proportions().
constexpr double kHandInLegs = 0.220;
constexpr double kHeadInLegs = 0.234;
constexpr double kShouldersInLegs = 0.428;

glm::dvec3 place(std::span<const RigidTransform> joints, JointIndex joint) {
  return joints[index(joint)].translation;
}

// In the T-pose's world.
Capsule capsule_between(std::span<const RigidTransform> t_pose,
                        JointIndex joint,
                        const glm::dvec3& start,
                        const glm::dvec3& end,
                        const glm::dvec3& along,
                        double radius_m) {
  const glm::dvec3 z = glm::normalize(along);
  const glm::dvec3 front =
      std::abs(z.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(front - z * glm::dot(front, z));
  const glm::dquat rotation =
      glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
  return {joint,
          inverse(t_pose[index(joint)]) * RigidTransform{rotation, 0.5 * (start + end)},
          0.5 * std::max(glm::dot(end - start, z), 0.0),
          radius_m};
}

void add_bone(std::span<const RigidTransform> t_pose,
              JointIndex joint,
              const glm::dvec3& end,
              double radius,
              std::optional<Capsule>& out) {
  const glm::dvec3 start = place(t_pose, joint);
  const double length_m = glm::distance(start, end);
  if (length_m <= 0.0) return;
  out = capsule_between(t_pose, joint, start, end, end - start, radius * length_m);
}

// A hand's capsule ends at the finger tips, its skin included.
void add_hand(const Skeleton& skeleton,
              const BodyMap& map,
              std::span<const RigidTransform> t_pose,
              const LimbMap& arm,
              std::optional<Capsule>& out) {
  const auto& tip_in_joint = skeleton[arm.end].tip_in_joint;
  const RigidTransform& wrist = t_pose[index(arm.end)];
  glm::dvec3 hand = arm.along_in_t_pose * (kHandInLegs * map.leg_length_m);
  if (tip_in_joint && glm::length(*tip_in_joint) > 0.0) {
    hand = wrist.rotation * *tip_in_joint;
  }
  const double radius_m = kHandRadius * glm::length(hand);
  const glm::dvec3 along = glm::normalize(hand);
  out = capsule_between(t_pose,
                        arm.end,
                        wrist.translation + along * radius_m,
                        wrist.translation + hand - along * radius_m,
                        along,
                        radius_m);
}

void add_limbs(const Skeleton& skeleton,
               const BodyMap& map,
               std::span<const RigidTransform> t_pose,
               BodyVolume& out) {
  for (int side = 0; side < 2; ++side) {
    const LimbMap& leg = map.leg(side);
    add_bone(t_pose,
             leg.upper,
             place(t_pose, leg.lower),
             kThighRadius,
             out[on_side(P::kLeftThigh, side)]);
    add_bone(t_pose,
             leg.lower,
             place(t_pose, leg.end),
             kShankRadius,
             out[on_side(P::kLeftShank, side)]);
    const auto& arm = map.limbs[static_cast<std::size_t>(side)];
    if (!arm) continue;
    add_bone(t_pose,
             arm->upper,
             place(t_pose, arm->lower),
             kUpperArmRadius,
             out[on_side(P::kLeftUpperArm, side)]);
    add_bone(t_pose,
             arm->lower,
             place(t_pose, arm->end),
             kForearmRadius,
             out[on_side(P::kLeftForearm, side)]);
    add_hand(skeleton, map, t_pose, *arm, out[on_side(P::kLeftHand, side)]);
  }
}

JointIndex last_of(const SpineSection& section, JointIndex otherwise) {
  if (section.count == 0) return otherwise;
  return section.joints[static_cast<std::size_t>(section.count - 1)];
}

void add_trunk(const BodyMap& map,
               std::span<const RigidTransform> t_pose,
               BodyVolume& out) {
  const auto at = [&](JointIndex joint) { return place(t_pose, joint); };
  const JointIndex abdomen = last_of(map.abdomen, map.hips());
  const JointIndex chest = last_of(map.torso, abdomen);
  const glm::dvec3 low = 0.5 * (at(map.leg(0).upper) + at(map.leg(1).upper));
  const double hips_m = glm::distance(at(map.leg(0).upper), at(map.leg(1).upper));
  double shoulders_m = kShouldersInLegs * map.leg_length_m;
  if (map.limbs[0] && map.limbs[1]) {
    shoulders_m = glm::distance(at(map.limbs[0]->upper), at(map.limbs[1]->upper));
  }
  auto top = map.joint_of[index(B::kNeck)];
  if (!top) top = map.joint_of[index(B::kHead)];
  const glm::dvec3 high = at(top.value_or(chest));
  const double height_m = glm::distance(low, high);
  for (const TrunkSlice& slice : kTrunkSlices) {
    const double across_m =
        slice.shoulders_share * shoulders_m + (1.0 - slice.shoulders_share) * hips_m;
    const double radius_m = 0.5 * slice.depth * height_m;
    const double half_m = std::max(0.5 * slice.breadth * across_m - radius_m, 0.0);
    const glm::dvec3 middle = low + slice.height * (high - low);
    const JointIndex joint = slice.part == P::kPelvis    ? map.hips()
                             : slice.part == P::kAbdomen ? abdomen
                                                         : chest;
    const glm::dvec3 left(1, 0, 0);
    out[slice.part] = capsule_between(
        t_pose, joint, middle - half_m * left, middle + half_m * left, left, radius_m);
  }
}

void add_head(const Skeleton& skeleton,
              const BodyMap& map,
              std::span<const RigidTransform> t_pose,
              BodyVolume& out) {
  const auto joint = map.joint_of[index(B::kHead)];
  if (!joint) return;
  glm::dvec3 up(0.0, kHeadInLegs * map.leg_length_m, 0.0);
  if (const auto& tip = skeleton[*joint].tip_in_joint; tip && glm::length(*tip) > 0.0) {
    up = t_pose[index(*joint)].rotation * *tip;
  }
  const glm::dvec3 base = place(t_pose, *joint);
  out[P::kHead] = capsule_between(t_pose,
                                  *joint,
                                  base + kHeadStart * up,
                                  base + (1.0 - kHeadRadius) * up,
                                  up,
                                  kHeadRadius * glm::length(up));
}

}  // namespace

std::string_view name(VolumePart part) {
  constexpr std::array<std::string_view, kVolumePartCount> kNames{"head",
                                                                  "chest",
                                                                  "abdomen",
                                                                  "pelvis",
                                                                  "left upper arm",
                                                                  "left forearm",
                                                                  "left hand",
                                                                  "left thigh",
                                                                  "left shank",
                                                                  "right upper arm",
                                                                  "right forearm",
                                                                  "right hand",
                                                                  "right thigh",
                                                                  "right shank"};
  return kNames[index(part)];
}

CapsuleSide side_of(const Capsule& capsule, const glm::dvec3& p) {
  const double z = std::clamp(p.z, -capsule.half_length_m, capsule.half_length_m);
  const glm::dvec3 from_axis(p.x, p.y, p.z - z);
  const double off_m = glm::length(from_axis);
  if (off_m < 1e-12) return {-capsule.radius_m, {1, 0, 0}};
  return {off_m - capsule.radius_m, from_axis / off_m};
}

CapsuleSide side_of(const Capsule& capsule,
                    std::span<const RigidTransform> world_from_joint,
                    const glm::dvec3& p_in_world) {
  const RigidTransform world_from_capsule =
      world_from_joint[index(capsule.joint)] * capsule.joint_from_capsule;
  CapsuleSide side = side_of(capsule, inverse(world_from_capsule) * p_in_world);
  side.outward = world_from_capsule.rotation * side.outward;
  return side;
}

double lowest_m(const BodyVolume& volume,
                int side,
                const RigidTransform& world_from_hand) {
  const auto& skin = volume.hand_skin_in_joint[static_cast<std::size_t>(side)];
  const auto height_m = [&](const glm::dvec3& p) { return (world_from_hand * p).y; };
  if (skin.empty()) {
    const Capsule& hand = *volume[on_side(P::kLeftHand, side)];
    return std::min(height_m(axis_point_in_joint(hand, -1.0)),
                    height_m(axis_point_in_joint(hand, 1.0))) -
           hand.radius_m;
  }
  double lowest = height_m(skin.front());
  for (const glm::dvec3& p : skin) lowest = std::min(lowest, height_m(p));
  return lowest;
}

glm::dvec3 axis_point_in_joint(const Capsule& capsule, double along) {
  return capsule.joint_from_capsule * glm::dvec3(0, 0, along * capsule.half_length_m);
}

glm::dvec3 carried_over(const Capsule& from,
                        const glm::dvec3& p,
                        double ball_at_from_m,
                        const Capsule& to,
                        double ball_at_to_m) {
  const double wider = to.radius_m / from.radius_m;
  const double longer =
      (to.half_length_m + to.radius_m) / (from.half_length_m + from.radius_m);
  const glm::dvec3 sized(p.x * wider, p.y * wider, p.z * longer);
  const double gap_m = side_of(from, p).distance_m - ball_at_from_m;
  const double off_m = std::max(to.radius_m + ball_at_to_m + gap_m, 0.0);
  const double z = std::clamp(sized.z, -to.half_length_m, to.half_length_m);
  return glm::dvec3(0, 0, z) + off_m * side_of(to, sized).outward;
}

PlaceOnPart place_on(const Capsule& capsule, const glm::dvec3& p_in_capsule) {
  const double z =
      std::clamp(p_in_capsule.z, -capsule.half_length_m, capsule.half_length_m);
  const glm::dvec3 p =
      glm::dvec3(0, 0, z) + capsule.radius_m * side_of(capsule, p_in_capsule).outward;
  return {std::clamp(p.z / (capsule.half_length_m + capsule.radius_m), -1.0, 1.0),
          std::atan2(p.y, p.x)};
}

glm::dvec3 surface_point_in_joint(const Capsule& capsule, const PlaceOnPart& place) {
  const double r = capsule.radius_m;
  const double z = place.along * (capsule.half_length_m + r);
  const double beyond = std::max(std::abs(z) - capsule.half_length_m, 0.0);
  const double radial = std::sqrt(std::max(r * r - beyond * beyond, 0.0));
  return capsule.joint_from_capsule * glm::dvec3(radial * std::cos(place.around_rad),
                                                 radial * std::sin(place.around_rad),
                                                 z);
}

std::vector<RigidTransform> t_pose_joints(const Skeleton& skeleton, const BodyMap& map) {
  MAREY_ASSERT(skeleton.joints.size() == map.joints.size());
  std::vector<RigidTransform> t_pose(skeleton.joints.size());
  for (std::size_t i = 0; i < t_pose.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    t_pose[i] = joint.parent_from_joint;
    if (joint.parent) t_pose[i] = t_pose[index(*joint.parent)] * t_pose[i];
    if (map.joints[i].role != JointRole::kFree) {
      t_pose[i].rotation = map.joints[i].t_pose_from_joint;
    }
  }
  return t_pose;
}

BodyVolume average_volume(const Skeleton& skeleton, const BodyMap& map) {
  const std::vector<RigidTransform> t_pose = t_pose_joints(skeleton, map);
  BodyVolume out;
  add_head(skeleton, map, t_pose, out);
  add_trunk(map, t_pose, out);
  add_limbs(skeleton, map, t_pose, out);
  return out;
}

}  // namespace marey::retarget
