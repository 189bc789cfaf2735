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
constexpr std::size_t kParts = 5;

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

/// How far a leg is from bearing a standing body, with its foot on the floor: 0 at best.
double leg_unrest(const Seen& view, const HumanLimb& limb, double floor, double length) {
  const B toes = limb.end == B::kLeftFoot ? B::kLeftToes : B::kRightToes;
  const double upper = 1.0 + glm::dot(view.bone(limb.upper, limb.lower), view.up);
  const double lower = 1.0 + glm::dot(view.bone(limb.lower, limb.end), view.up);
  double low = view.height(limb.end);
  if (view.found.joint(toes)) low = 0.5 * (low + view.height(toes));
  return upper + lower + 2.0 * std::abs(low - floor) / length;
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

/// Which part each joint belongs to: a limb from its root down, else the trunk.
std::vector<std::size_t> parts_of(const Skeleton& skeleton, const FoundBones& found) {
  std::vector<std::size_t> parts(skeleton.joints.size(), kTrunk);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& parent = skeleton.joints[i].parent;
    if (parent) parts[i] = parts[index(*parent)];
    for (std::size_t limb = 0; limb < 4; ++limb) {
      const auto root = found.joint(human_limbs()[limb].upper);
      if (root && index(*root) == i) parts[i] = limb;
    }
  }
  return parts;
}

/// Where up is, and how low the feet get.
struct Ground {
  glm::dvec3 up{0.0};
  std::array<double, 2> floor{};
  double leg = 1e-9;
};

Ground ground_of(const Motion& motion,
                 const FoundBones& found,
                 std::span<RigidTransform> world) {
  const Skeleton& skeleton = motion.skeleton;
  const auto place = [&](JointIndex joint) { return world[index(joint)].translation; };
  Ground ground;
  // Most of the time hips are above feet.
  for (const Pose& pose : motion.poses) {
    world_from_joints(skeleton, pose, world);
    const Places p = places_of(found, place);
    ground.up += unit_of(p.mid_hip() - p.mid_foot());
    ground.leg = std::max(ground.leg, glm::distance(p.hip[0], p.foot[0]));
  }
  ground.up = snapped(unit_of(ground.up), 0.8);
  ground.floor.fill(std::numeric_limits<double>::infinity());
  for (const Pose& pose : motion.poses) {
    world_from_joints(skeleton, pose, world);
    const Seen view{found, world, ground.up};
    for (std::size_t side = 0; side < 2; ++side) {
      const B foot = side == 0 ? B::kLeftFoot : B::kRightFoot;
      const B toes = side == 0 ? B::kLeftToes : B::kRightToes;
      double low = view.height(foot);
      if (found.joint(toes)) low = 0.5 * (low + view.height(toes));
      ground.floor[side] = std::min(ground.floor[side], low);
    }
  }
  return ground;
}

glm::dquat facing(const Seen& view) {
  const glm::dvec3 usual = view.up.z > 0.5 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  const bool is_level = std::abs(glm::dot(usual, view.up)) < 0.5;
  if (!is_level || view.front == glm::dvec3(0.0)) return {1.0, 0.0, 0.0, 0.0};
  return rotation_between(view.front, usual);
}

}  // namespace

void rest_as_standing(Motion& motion, const FoundBones& found) {
  Skeleton& skeleton = motion.skeleton;
  std::vector<RigidTransform> world(skeleton.joints.size());
  const Ground ground = ground_of(motion, found, world);
  std::array<double, kParts> least{};
  least.fill(std::numeric_limits<double>::infinity());
  std::array<std::size_t, kParts> frame{};
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    world_from_joints(skeleton, motion.poses[i], world);
    const Seen view = seen(found, world, ground.up);
    for (std::size_t part = 0; part < kParts; ++part) {
      double unrest = 0.0;
      if (part == kTrunk) {
        unrest = trunk_unrest(view);
      } else if (part < 2) {
        unrest = arm_unrest(view, human_limbs()[part]);
      } else {
        unrest =
            leg_unrest(view, human_limbs()[part], ground.floor[part - 2], ground.leg);
      }
      if (unrest >= least[part]) continue;
      least[part] = unrest;
      frame[part] = i;
    }
  }
  const std::vector<std::size_t> parts = parts_of(skeleton, found);
  std::vector<glm::dquat> rest(skeleton.joints.size());
  for (std::size_t part = 0; part < kParts; ++part) {
    world_from_joints(skeleton, motion.poses[frame[part]], world);
    const glm::dquat turn = facing(seen(found, world, ground.up));
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (parts[i] == part) rest[i] = glm::normalize(turn * world[i].rotation);
    }
  }
  const glm::dvec3 root =
      ground.up * glm::dot(motion.poses[frame[kTrunk]].root_in_world, ground.up);
  const Pose pose = pose_from_world(skeleton, root, rest);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    skeleton.joints[i].parent_from_joint.rotation = pose.parent_from_joint[i];
  }
  skeleton.joints[0].parent_from_joint.translation = root;
}

}  // namespace marey::retarget
