// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body_frame.h"
#include "retarget/body_places.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr std::size_t kTrunk = 4;  // Behind the four limbs of human_limbs().
constexpr std::size_t kFeet = 5;   // Left and right, toes included.
constexpr std::size_t kParts = 7;

/// One frame of the motion, seen with the body's own left and front.
struct Seen {
  const FoundBones& found;
  std::span<const RigidTransform> world;
  glm::dvec3 up;
  glm::dvec3 left{0.0};
  glm::dvec3 front{0.0};

  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world[index(joint)].translation;
  }
  /// Direction from bone to bone; zero where one is missing.
  [[nodiscard]] glm::dvec3 bone(B from, B to) const {
    const auto a = found.joint(from);
    const auto b = found.joint(to);
    return a && b ? unit_of(place(*b) - place(*a)) : glm::dvec3(0.0);
  }
  [[nodiscard]] double height(B bone) const {
    const auto joint = found.joint(bone);
    return joint ? glm::dot(place(*joint), up) : 0.0;
  }
};

Seen seen(const FoundBones& found,
          std::span<const RigidTransform> world,
          const glm::dvec3& up) {
  Seen view{found, world, up};
  const Places p = places_of(found, [&](JointIndex joint) { return view.place(joint); });
  const glm::dvec3 across = p.hip[0] - p.hip[1];
  view.left = unit_of(across - up * glm::dot(across, up));
  view.front = glm::cross(view.left, up);
  return view;
}

/// How far a leg is from hanging straight: 0 at best.
double leg_unrest(const Seen& view, const HumanLimb& limb) {
  return 2.0 + glm::dot(view.bone(limb.upper, limb.lower), view.up) +
         glm::dot(view.bone(limb.lower, limb.end), view.up);
}

/// A foot that bears is as low as it gets.
double foot_height(const Seen& view, std::size_t side) {
  const B foot = side == 0 ? B::kLeftFoot : B::kRightFoot;
  const B toes = side == 0 ? B::kLeftToes : B::kRightToes;
  const double ankle = view.height(foot);
  return view.found.joint(toes) ? 0.5 * (ankle + view.height(toes)) : ankle;
}

/// An arm may hang, or lie anywhere else in the plane of the body's sides, if straight.
double arm_unrest(const Seen& view, const HumanLimb& limb) {
  const glm::dvec3 upper = view.bone(limb.upper, limb.lower);
  const glm::dvec3 lower = view.bone(limb.lower, limb.end);
  return std::abs(glm::dot(upper, view.front)) + std::abs(glm::dot(lower, view.front)) +
         1.0 - glm::dot(upper, lower);
}

double trunk_unrest(const Seen& view) {
  double sum = 0.0;
  for (const B bone : {B::kSpine, B::kNeck, B::kHead}) {
    const glm::dvec3 way = view.bone(B::kHips, bone);
    if (way != glm::dvec3(0.0)) sum += 1.0 - glm::dot(way, view.up);
  }
  const glm::dvec3 arms = view.bone(B::kRightUpperArm, B::kLeftUpperArm);
  if (arms != glm::dvec3(0.0)) sum += 1.0 - glm::dot(arms, view.left);
  return sum;
}

/// Which part each joint belongs to: a limb from its root to a foot, a foot, else the
/// trunk.
std::vector<std::size_t> parts_of(const Skeleton& skeleton, const FoundBones& found) {
  std::vector<std::size_t> parts(skeleton.joints.size(), kTrunk);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& parent = skeleton.joints[i].parent;
    if (parent) parts[i] = parts[index(*parent)];
    for (std::size_t limb = 0; limb < 4; ++limb) {
      const auto root = found.joint(human_limbs()[limb].upper);
      if (root && index(*root) == i) parts[i] = limb;
      const auto end = found.joint(human_limbs()[limb].end);
      if (limb >= 2 && end && index(*end) == i) parts[i] = kFeet + limb - 2;
    }
  }
  return parts;
}

/// Most of the time hips are above feet.
glm::dvec3 up_of(const Motion& motion,
                 const FoundBones& found,
                 std::span<RigidTransform> world) {
  glm::dvec3 up(0.0);
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    const Places p =
        places_of(found, [&](JointIndex joint) { return world[index(joint)].translation; });
    up += unit_of(p.mid_hip() - p.mid_foot());
  }
  return snapped(unit_of(up), 0.8);
}

glm::dquat facing(const Seen& view) {
  const glm::dvec3 usual = view.up.z > 0.5 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  const bool is_level = std::abs(glm::dot(usual, view.up)) < 0.5;
  if (!is_level || view.front == glm::dvec3(0.0)) return {1.0, 0.0, 0.0, 0.0};
  return rotation_between(view.front, usual);
}

double unrest_of(const Seen& view, std::size_t part) {
  if (part == kTrunk) return trunk_unrest(view);
  if (part >= kFeet) return foot_height(view, part - kFeet);
  const HumanLimb& limb = human_limbs()[part];
  return part < 2 ? arm_unrest(view, limb) : leg_unrest(view, limb);
}

/// The frame in which each part stands best.
std::array<std::size_t, kParts> best_frames(const Motion& motion,
                                            const FoundBones& found,
                                            const glm::dvec3& up,
                                            std::span<RigidTransform> world) {
  std::array<double, kParts> least{};
  least.fill(std::numeric_limits<double>::infinity());
  std::array<std::size_t, kParts> frame{};
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    world_from_joints(motion.skeleton, motion.poses[i], world);
    const Seen view = seen(found, world, up);
    for (std::size_t part = 0; part < kParts; ++part) {
      const double unrest = unrest_of(view, part);
      if (unrest >= least[part]) continue;
      least[part] = unrest;
      frame[part] = i;
    }
  }
  return frame;
}

}  // namespace

void rest_as_standing(Motion& motion, const FoundBones& found) {
  Skeleton& skeleton = motion.skeleton;
  std::vector<RigidTransform> world(skeleton.joints.size());
  const glm::dvec3 up = up_of(motion, found, world);
  const auto frame = best_frames(motion, found, up, world);
  const std::vector<std::size_t> parts = parts_of(skeleton, found);
  std::vector<glm::dquat> rest(skeleton.joints.size());
  double feet = 0.0;  // How high both are when they bear.
  for (std::size_t part = 0; part < kParts; ++part) {
    world_from_joints(skeleton, motion.poses[frame[part]], world);
    const Seen view = seen(found, world, up);
    const glm::dquat turn = facing(view);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (parts[i] == part) rest[i] = glm::normalize(turn * world[i].rotation);
    }
    if (part >= kFeet) feet += 0.5 * foot_height(view, part - kFeet);
  }
  Pose pose = pose_from_world(skeleton, glm::dvec3(0.0), rest);
  world_from_joints(skeleton, pose, world);
  const Seen stands = seen(found, world, up);
  const double now = 0.5 * (foot_height(stands, 0) + foot_height(stands, 1));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    skeleton.joints[i].parent_from_joint.rotation = pose.parent_from_joint[i];
  }
  skeleton.joints[0].parent_from_joint.translation = (feet - now) * up;
}

}  // namespace marey::retarget
