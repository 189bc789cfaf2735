// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/normalized_skeleton.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/assert.h"
#include "core/base/smooth_step.h"
#include "retarget/body/place_spine.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {
namespace {

constexpr double kNoDistance =
    1e-9;  // Share of a limb: closer than this is the same place.
// An elbow this far from the axis, over the shorter bone, determines the half-plane (12
// degrees of flexion); at a third of it (4 degrees) it does not.
constexpr double kBentOffset = 0.105;
constexpr double kStraightOffset = 0.035;

glm::dquat rotation_of_axes(const glm::dvec3& x,
                            const glm::dvec3& y,
                            const glm::dvec3& z) {
  return glm::normalize(glm::quat_cast(glm::dmat3(x, y, z)));
}

// Returns a unit vector perpendicular to the unit `axis`, near `preferred` if possible.
glm::dvec3 perpendicular(const glm::dvec3& preferred, const glm::dvec3& axis) {
  glm::dvec3 v = preferred - axis * glm::dot(preferred, axis);
  if (glm::dot(v, v) < 1e-12) {
    const glm::dvec3 other =
        std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    v = other - axis * glm::dot(other, axis);
  }
  return glm::normalize(v);
}

// Returns the T-pose's bone axes as a limb frame: Z along the limb, hinge along -Y,
// because bending about the hinge n moves the middle joint towards X = Z x n.
glm::dquat limb_from_t_pose(const LimbMap& limb) {
  const glm::dvec3 z = limb.along_in_t_pose;
  const glm::dvec3 y = -limb.hinge_in_t_pose;
  return glm::conjugate(rotation_of_axes(glm::cross(y, z), y, z));
}

// Returns the world rotation from the T-pose of a bone that lies along `direction` with
// its hinge in the limb's half-plane: no twist.
glm::dquat untwisted(const LimbMap& limb,
                     const glm::dquat& world_from_limb,
                     const glm::dvec3& direction) {
  const glm::dvec3 axis = world_from_limb * glm::dvec3(0, 0, 1);
  return rotation_between(axis, direction) * world_from_limb * limb_from_t_pose(limb);
}

double twist_angle_rad(const glm::dquat& from,
                       const glm::dquat& to,
                       const glm::dvec3& axis) {
  const glm::dquat twist = glm::conjugate(from) * to;
  const double sine = glm::dot(glm::dvec3(twist.x, twist.y, twist.z), axis);
  const double angle = 2.0 * std::atan2(sine, twist.w);
  return std::remainder(angle, 2.0 * 3.14159265358979323846);
}

struct LimbPlaces {
  glm::dvec3 mid_from_root;
  glm::dvec3 end_from_root;
};

// Returns the frame of NormalizedLimb, continuous through the straight limb.
glm::dquat limb_frame(const LimbMap& limb, const LimbPlaces& p, const glm::dvec3& hinge) {
  const double distance = glm::length(p.end_from_root);
  if (distance < kNoDistance * limb.length_m()) {
    // Folded onto itself: the bone itself is in the half-plane, and the axis is the
    // third.
    const glm::dvec3 x = glm::normalize(p.mid_from_root);
    const glm::dvec3 n = perpendicular(hinge, x);
    return rotation_of_axes(x, -n, glm::cross(n, x));
  }
  const glm::dvec3 z = p.end_from_root / distance;
  const glm::dvec3 radial = p.mid_from_root - z * glm::dot(p.mid_from_root, z);
  const double offset = glm::length(radial);
  const double shorter = std::min(limb.upper_length_m, limb.lower_length_m);
  const double bent =
      smooth_step((offset / shorter - kStraightOffset) / (kBentOffset - kStraightOffset));
  const glm::dvec3 own = glm::cross(z, perpendicular(hinge, z));
  glm::dvec3 x = own;
  if (bent > 0.0) {
    // Opposite directions that cancel have no mean; the hinge decides then.
    const glm::dvec3 mean = own * (1.0 - bent) + radial * (bent / offset);
    x = perpendicular(glm::dot(mean, mean) > 1e-12 ? mean : own, z);
  }
  return rotation_of_axes(x, glm::cross(z, x), z);
}

NormalizedLimb normalize_limb(const BodyMap& map,
                              const LimbMap& limb,
                              std::span<const RigidTransform> world_from_joint) {
  const glm::dvec3 root = world_from_joint[index(limb.upper)].translation;
  const LimbPlaces p{world_from_joint[index(limb.lower)].translation - root,
                     world_from_joint[index(limb.end)].translation - root};
  const glm::dquat upper = rotation_from_t_pose(map, world_from_joint, limb.upper);
  const glm::dquat lower = rotation_from_t_pose(map, world_from_joint, limb.lower);

  NormalizedLimb out;
  out.extension = std::min(glm::length(p.end_from_root) / limb.length_m(), 1.0);
  out.world_from_limb = limb_frame(limb, p, upper * limb.hinge_in_t_pose);
  const glm::dvec3 mid_in_limb = glm::conjugate(out.world_from_limb) * p.mid_from_root;
  out.mid_offset = glm::dvec2(mid_in_limb) / limb.length_m();
  const glm::dvec3& along = limb.along_in_t_pose;
  const glm::dvec3 lower_bone = p.end_from_root - p.mid_from_root;
  out.upper_twist_rad = twist_angle_rad(
      untwisted(limb, out.world_from_limb, p.mid_from_root), upper, along);
  out.lower_twist_rad =
      twist_angle_rad(untwisted(limb, out.world_from_limb, lower_bone), lower, along);
  return out;
}

// Returns the direction of the middle joint about the axis: on the half-plane, except for
// the small deviation of a nearly straight limb.
glm::dvec2 mid_direction(const glm::dvec2& stray_m, double offset_m) {
  const double stray = glm::length(stray_m);
  glm::dvec2 v = stray_m;
  if (offset_m > stray) v.x += offset_m - stray;
  const double length = glm::length(v);
  return length > 1e-12 ? v / length : glm::dvec2(1, 0);
}

// Eq. 1.4 and the law of cosines: middle and end joint in the limb's frame. [m]
LimbPlaces solve_limb(const LimbMap& limb, const NormalizedLimb& n) {
  const double l1 = limb.upper_length_m;
  const double l2 = limb.lower_length_m;
  const double full = l1 + l2;
  const double shortest = std::abs(l1 - l2);
  const double distance = std::clamp(n.extension * full, shortest, full);
  double along = 0.0;
  double offset = l1;
  if (distance > kNoDistance * full) {
    along = 0.5 * (distance + (l1 - l2) * full / distance);
    // Heron's form: exact near the straight limb, where l1^2 - along^2 cancels.
    const double squared = (full - distance) * (full + distance) * (distance - shortest) *
                           (distance + shortest);
    offset = 0.5 * std::sqrt(std::max(squared, 0.0)) / distance;
  }
  const glm::dvec2 side = offset * mid_direction(n.mid_offset * full, offset);
  return {{side.x, side.y, along}, {0.0, 0.0, distance}};
}

void place_limb(const BodyMap& map,
                const LimbMap& limb,
                const NormalizedLimb& n,
                std::span<RigidTransform> world_from_joint) {
  const LimbPlaces in_limb = solve_limb(limb, n);
  const auto bone = [&](JointIndex joint, const glm::dvec3& in_limb_frame, double twist) {
    const glm::dvec3 direction = n.world_from_limb * in_limb_frame;
    world_from_joint[index(joint)].rotation =
        untwisted(limb, n.world_from_limb, direction) *
        glm::angleAxis(twist, limb.along_in_t_pose) *
        map.joints[index(joint)].t_pose_from_joint;
  };
  bone(limb.upper, in_limb.mid_from_root, n.upper_twist_rad);
  bone(limb.lower, in_limb.end_from_root - in_limb.mid_from_root, n.lower_twist_rad);
}

void normalize_spine(const BodyMap& map,
                     std::span<const RigidTransform> world_from_joint,
                     NormalizedPose& out) {
  const auto add_section = [&](const SpineSection& section, RotationCurve& curve) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
      curve.add(section.at[i],
                rotation_from_t_pose(map, world_from_joint, section.joints[i]));
    }
  };
  const glm::dquat hips = rotation_from_t_pose(map, world_from_joint, map.hips());
  out.abdomen.count = 0;
  out.torso.count = 0;
  out.abdomen.add(0.0, hips);
  if (map.abdomen.count > 0) {
    add_section(map.abdomen, out.abdomen);
  } else if (map.torso.count > 0) {
    // One stiff trunk: a body that has an abdomen bends it half way.
    const glm::dquat torso =
        rotation_from_t_pose(map, world_from_joint, map.torso.joints[0]);
    out.abdomen.add(1.0, glm::slerp(hips, torso, 0.5));
  }
  out.torso.add(0.0, sample(out.abdomen, 1.0));
  add_section(map.torso, out.torso);
  out.spine.reset();
  if (map.spine) out.spine = map.spine->shares;
  out.neck.count = 0;
  if (map.neck.count == 0) return;
  out.neck.add(0.0, sample(out.torso, 1.0));
  add_section(map.neck, out.neck);
}

bool is_driven(const JointDrive& drive, const NormalizedPose& pose) {
  switch (drive.role) {
    case JointRole::kFree:
      return false;
    case JointRole::kSegment:
      return pose.segments[index(drive.bone)].has_value();
    case JointRole::kVertebra:
      return true;
    case JointRole::kNeck:
      return pose.neck.count > 0;
    case JointRole::kLimbBone:
      return pose.limbs[static_cast<std::size_t>(drive.limb)].has_value();
  }
  return false;
}

// Driven joints have their world rotation already; the others follow their parent.
// Positions are relative to the root joint until the hips are placed.
void place_joints(const NormalizedPose& pose,
                  const Skeleton& body,
                  const BodyMap& map,
                  std::span<RigidTransform> world_from_joint,
                  Pose& out) {
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    const Joint& joint = body.joints[i];
    RigidTransform& world = world_from_joint[i];
    const RigidTransform parent =
        joint.parent ? world_from_joint[index(*joint.parent)] : RigidTransform{};
    const glm::dquat& rest = joint.parent_from_joint.rotation;
    world.translation =
        joint.parent ? parent * joint.parent_from_joint.translation : glm::dvec3(0.0);
    if (is_driven(map.joints[i], pose)) {
      world.rotation = glm::normalize(world.rotation);
      out.parent_from_joint[i] = glm::conjugate(parent.rotation) * world.rotation;
    } else {
      world.rotation = parent.rotation * rest;
      out.parent_from_joint[i] = rest;
    }
  }
  const glm::dvec3 hips_from_root = world_from_joint[index(map.hips())].translation;
  out.root_in_world =
      pose.root * root_unit_m(map, pose.root_normalization) - hips_from_root;
  for (RigidTransform& world : world_from_joint) world.translation += out.root_in_world;
}

}  // namespace

double root_unit_m(const BodyMap& map, RootNormalization root) {
  switch (root) {
    case RootNormalization::kLegLength:
      return map.leg_length_m;
    case RootNormalization::kArmLength:
      MAREY_ASSERT(map.arm_length_m > 0.0);
      return map.arm_length_m;
    case RootNormalization::kNone:
      return 1.0;
  }
  return 1.0;
}

void normalize(const BodyMap& map,
               std::span<const RigidTransform> world_from_joint,
               NormalizedPose& out,
               RootNormalization root) {
  MAREY_ASSERT(world_from_joint.size() == map.joints.size());
  out.root_normalization = root;
  out.root = world_from_joint[index(map.hips())].translation / root_unit_m(map, root);
  for (std::size_t i = 0; i < out.segments.size(); ++i) {
    const auto joint = map.joint_of[i];
    const bool own = joint && map.joints[index(*joint)].role == JointRole::kSegment;
    out.segments[i].reset();
    if (own) out.segments[i] = rotation_from_t_pose(map, world_from_joint, *joint);
  }
  for (std::size_t i = 0; i < out.limbs.size(); ++i) {
    out.limbs[i].reset();
    if (map.limbs[i]) {
      out.limbs[i] = normalize_limb(map, *map.limbs[i], world_from_joint);
    }
  }
  normalize_spine(map, world_from_joint, out);
}

NormalizedPose normalize(const Skeleton& skeleton,
                         const BodyMap& map,
                         const Pose& pose,
                         RootNormalization root) {
  NormalizedPose out;
  normalize(map, world_from_joints(skeleton, pose), out, root);
  return out;
}

void expand(const NormalizedPose& pose,
            const Skeleton& body,
            const BodyMap& map,
            std::span<RigidTransform> world_from_joint,
            Pose& out) {
  MAREY_ASSERT(body.joints.size() == map.joints.size());
  MAREY_ASSERT(world_from_joint.size() == map.joints.size());
  out.parent_from_joint.resize(body.joints.size());
  for (std::size_t i = 0; i < pose.segments.size(); ++i) {
    const auto joint = map.joint_of[i];
    if (!joint || !pose.segments[i]) continue;
    const JointDrive& drive = map.joints[index(*joint)];
    if (drive.role != JointRole::kSegment) continue;
    world_from_joint[index(*joint)].rotation =
        *pose.segments[i] * drive.t_pose_from_joint;
  }
  place_spine(pose, map, world_from_joint);
  place_neck(pose, map, world_from_joint);
  for (std::size_t i = 0; i < pose.limbs.size(); ++i) {
    if (!map.limbs[i] || !pose.limbs[i]) continue;
    place_limb(map, *map.limbs[i], *pose.limbs[i], world_from_joint);
  }
  place_joints(pose, body, map, world_from_joint, out);
}

Pose expand(const NormalizedPose& pose, const Skeleton& body, const BodyMap& map) {
  Pose out;
  std::vector<RigidTransform> world_from_joint(body.joints.size());
  expand(pose, body, map, world_from_joint, out);
  return out;
}

}  // namespace marey::retarget
