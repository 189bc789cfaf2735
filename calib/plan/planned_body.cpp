// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/planned_body.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/assert.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"

namespace marey::calib {
namespace {

using B = HumanBone;

constexpr double kHalfTurn_rad = std::numbers::pi;
constexpr double kOffSkin_m = 0.015;  // Thickness of a plate on a strap.

/// Position of a tag on a segment of the left side or the middle; mirrored on the right.
struct Spot {
  B segment;
  double share;    ///< Fraction of the distance to the segment's end.
  glm::dvec3 out;  ///< Outward normal, in the segment's frame.
  double skin;     ///< From the bone to the skin there, divided by the stature.
};

/// In order of use. Thicknesses are those of soft_tissue_of(), or more at muscles.
constexpr std::array<Spot, 28> kSpots{{
    {B::kHips, 0.0, {0.0, 0.0, 1.0}, 0.068},
    {B::kHips, 0.0, {0.0, 0.0, -1.0}, 0.074},
    {B::kHips, 0.0, {-0.75, 0.3, 0.6}, 0.085},
    {B::kHips, 0.0, {0.75, 0.3, 0.6}, 0.085},
    {B::kUpperChest, 0.3, {0.0, 0.0, 1.0}, 0.070},
    {B::kUpperChest, 0.4, {0.0, 0.0, -1.0}, 0.074},
    {B::kUpperChest, 0.3, {0.45, 0.0, -0.9}, 0.078},
    {B::kUpperChest, 0.3, {-0.45, 0.0, -0.9}, 0.078},
    {B::kHead, 0.6, {0.1, 0.5, 0.85}, 0.055},
    {B::kHead, 0.6, {0.85, 0.3, -0.45}, 0.055},
    {B::kHead, 0.6, {-0.85, 0.3, -0.45}, 0.055},
    {B::kHead, 0.6, {0.0, 0.3, -1.0}, 0.055},
    {B::kLeftUpperArm, 0.55, {0.0, 0.7, 0.7}, 0.028},
    {B::kLeftUpperArm, 0.65, {0.0, 0.65, -0.75}, 0.028},
    {B::kLeftUpperArm, 0.45, {0.0, 1.0, 0.0}, 0.028},
    {B::kLeftLowerArm, 0.45, {0.0, 0.74, 0.67}, 0.025},
    {B::kLeftLowerArm, 0.60, {0.0, 0.53, -0.85}, 0.025},
    {B::kLeftLowerArm, 0.30, {0.0, 1.0, 0.0}, 0.025},
    {B::kLeftHand, 0.50, {0.0, 1.0, 0.0}, 0.015},
    {B::kLeftHand, 0.50, {0.0, -1.0, 0.0}, 0.015},
    {B::kLeftUpperLeg, 0.45, {0.45, 0.15, 0.88}, 0.046},
    {B::kLeftUpperLeg, 0.45, {0.76, 0.25, -0.6}, 0.046},
    {B::kLeftUpperLeg, 0.60, {0.0, 0.1, -1.0}, 0.046},
    {B::kLeftLowerLeg, 0.35, {0.55, 0.2, 0.8}, 0.036},
    {B::kLeftLowerLeg, 0.40, {0.62, 0.25, -0.73}, 0.036},
    {B::kLeftLowerLeg, 0.40, {0.0, 0.1, -1.0}, 0.036},
    {B::kLeftFoot, 0.60, {0.0, 0.96, 0.27}, 0.028},
    {B::kLeftFoot, 0.10, {1.0, 0.3, 0.0}, 0.035},
}};

bool is_right(B bone) {
  return index(mirrored(bone)) < index(bone);
}

/// Returns the end of a bone in its own frame.
glm::dvec3 end_of(B bone, const Proportions& p) {
  switch (bone) {
    case B::kHead:
      return p.head_top_in_head;
    case B::kLeftHand:
      return p.left_hand_tip_in_hand;
    case B::kRightHand:
      return p.right_hand_tip_in_hand;
    case B::kHips:
      return p[B::kSpine];
    case B::kUpperChest:
      return p[B::kNeck];
    default:
      break;
  }
  for (const B child : human_bones()) {
    if (parent(child) == bone) return p[child];
  }
  return glm::dvec3(0.0);
}

RigidTransform glue(const Spot& spot, B segment, const PlannedBody& body) {
  glm::dvec3 out = glm::normalize(spot.out);
  if (is_right(segment)) out.x = -out.x;
  const glm::dvec3 along = end_of(segment, body.proportions);
  // Perpendicular to the bone: the plate is inclined, but stays on its muscle.
  glm::dvec3 off = out;
  if (segment != B::kHips && segment != B::kHead) {
    const glm::dvec3 unit = glm::normalize(along);
    off = glm::normalize(out - glm::dot(out, unit) * unit);
  }
  const glm::dvec3 into = -out;
  const glm::dvec3 helper =
      std::abs(into.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 right = glm::normalize(glm::cross(into, helper));
  return {glm::quat_cast(glm::dmat3(right, glm::cross(into, right), into)),
          spot.share * along + (spot.skin * body.stature_m + kOffSkin_m) * off};
}

glm::dquat about_x(double rad) {
  return rotation_from_vector({rad, 0.0, 0.0});
}
glm::dquat about_y(double rad) {
  return rotation_from_vector({0.0, rad, 0.0});
}
glm::dquat about_z(double rad) {
  return rotation_from_vector({0.0, 0.0, rad});
}

/// Joint angles [rad] in anatomical terms; unset joints are straight.
struct Attitude {
  double heading = 0.0;
  glm::dquat trunk{1, 0, 0, 0};  ///< Thorax relative to the hips.
  glm::dquat head{1, 0, 0, 0};   ///< Relative to the thorax.
  struct Limb {
    glm::dquat girdle{1, 0, 0, 0};  ///< Collar bone; legs have none.
    glm::dquat upper{1, 0, 0, 0};
    double flexion = 0.0;
    double twist = 0.0;  ///< Twist of the lower bone about its own axis.
    glm::dquat end{1, 0, 0, 0};
  };
  std::array<Limb, 4> limbs;  ///< In the order of human_limbs().
};

glm::dquat part(const glm::dquat& rotation, double share) {
  return rotation_from_vector(share * rotation_vector(rotation));
}

BodyPlace place_of(const PlannedBody& body,
                   const glm::dvec2& floor_m,
                   double lowered_m,
                   const Attitude& a) {
  const Skeleton skeleton = make_humanoid(body.proportions);
  Pose pose = rest_pose(skeleton);
  pose.root_in_world = {floor_m.x, body.proportions[B::kHips].y - lowered_m, floor_m.y};
  const auto at = [&](B bone) -> glm::dquat& {
    return pose.parent_from_joint[index(bone)];
  };
  at(B::kHips) = about_y(a.heading);
  // A spine bends evenly.
  at(B::kSpine) = at(B::kChest) = part(a.trunk, 0.25);
  at(B::kUpperChest) = part(a.trunk, 0.5);
  at(B::kNeck) = at(B::kHead) = part(a.head, 0.5);
  for (std::size_t i = 0; i < a.limbs.size(); ++i) {
    const HumanLimb& bones = human_limbs()[i];
    if (i < 2) at(*parent(bones.upper)) = a.limbs[i].girdle;
    at(bones.upper) = a.limbs[i].upper;
    const glm::dvec3 along = glm::normalize(body.proportions[bones.end]);
    at(bones.lower) = rotation_from_vector(a.limbs[i].flexion * bones.hinge_axis) *
                      rotation_from_vector(a.limbs[i].twist * along);
    at(bones.end) = a.limbs[i].end;
  }
  BodyPlace out;
  world_from_joints(skeleton, pose, out);
  return out;
}

double side_of(std::size_t limb) {
  return limb % 2 == 0 ? 1.0 : -1.0;
}

/// Returns a wave of `turns` periods over the whole motion, with a phase per `place`.
double wave(double share, double turns, int place) {
  return std::sin(2.0 * kHalfTurn_rad * turns * share + 1.9 * place);
}

}  // namespace

std::vector<TagOnSegment> typical_tags(double size_m) {
  MAREY_ASSERT(size_m > 0.0);
  std::vector<TagOnSegment> tags;
  const auto add = [&](B segment, int count) {
    for (int i = 0; i < count; ++i) {
      tags.push_back({TagId{static_cast<int>(tags.size())}, segment, size_m});
    }
  };
  for (const B middle : {B::kHips, B::kUpperChest, B::kHead}) add(middle, 3);
  for (const HumanLimb& limb : human_limbs()) {
    add(limb.upper, 2);
    add(limb.lower, 2);
    add(limb.end, 1);
  }
  return tags;
}

PlannedBody make_planned_body(double stature_m, std::span<const TagOnSegment> tags) {
  MAREY_ASSERT(stature_m > 0.0);
  PlannedBody body{stature_m, average_proportions(stature_m), {}};
  std::array<int, kHumanBoneCount> worn{};
  for (const TagOnSegment& tag : tags) {
    MAREY_ASSERT(tag.size_m > 0.0);
    const B left = is_right(tag.segment) ? mirrored(tag.segment) : tag.segment;
    int before = worn[index(tag.segment)]++;
    for (const Spot& spot : kSpots) {
      if (spot.segment != left || before-- > 0) continue;
      body.tags.push_back({tag, glue(spot, tag.segment, body), 0.0, 0.0, 0});
      break;
    }
  }
  return body;
}

BodyPlace standing_body(const PlannedBody& body,
                        const glm::dvec2& floor_m,
                        double heading_rad) {
  Attitude a;
  a.heading = heading_rad;
  for (std::size_t i = 0; i < 2; ++i) {
    a.limbs[i].upper = about_z(-side_of(i) * glm::radians(70.0));
    a.limbs[i].flexion = 0.1;
  }
  return place_of(body, floor_m, 0.0, a);
}

BodyPlace walking_body(const PlannedBody& body,
                       const glm::dvec2& floor_m,
                       double heading_rad,
                       double phase_rad) {
  Attitude a;
  a.heading = heading_rad;
  a.trunk = about_x(0.06) * about_y(0.1 * std::sin(phase_rad));
  for (std::size_t i = 0; i < 4; ++i) {
    Attitude::Limb& limb = a.limbs[i];
    // An arm swings with the leg of the other side.
    const double phase = phase_rad + (i == 0 || i == 3 ? kHalfTurn_rad : 0.0);
    if (i < 2) {
      limb.upper =
          about_x(-0.35 * std::sin(phase)) * about_z(-side_of(i) * glm::radians(78.0));
      limb.flexion = 0.35 + 0.2 * std::sin(phase);
      continue;
    }
    const double swing = 0.08 + 0.4 * std::sin(phase);
    limb.upper = about_x(-swing);
    // Largest flexion while the thigh swings forward.
    limb.flexion = 0.15 + 0.9 * std::pow(std::max(0.0, std::cos(phase)), 2.0);
    // The sole is horizontal, or rolls off behind the body.
    limb.end = about_x(swing - limb.flexion + 0.4 * std::max(0.0, -std::sin(phase)));
  }
  return place_of(body, floor_m, 0.02 * body.stature_m, a);
}

BodyPlace exercising_body(const PlannedBody& body,
                          const glm::dvec2& floor_m,
                          double share) {
  Attitude a;
  a.heading = 2.0 * kHalfTurn_rad * share;
  a.trunk = about_x(0.15 + 0.35 * wave(share, 3.3, 6)) *
            about_y(0.3 * wave(share, 4.3, 7)) * about_z(0.2 * wave(share, 3.7, 8));
  a.head = about_x(0.3 * wave(share, 4.7, 9)) * about_y(0.5 * wave(share, 3.9, 10));
  for (std::size_t i = 0; i < 4; ++i) {
    Attitude::Limb& limb = a.limbs[i];
    const double side = side_of(i);
    const int k = 20 + 7 * static_cast<int>(i);
    if (i < 2) {
      limb.upper = about_z(side * (-0.9 + 0.7 * wave(share, 4.5, k + 2))) *
                   about_y(0.6 * wave(share, 3.6, k + 3)) *
                   about_x(0.4 * wave(share, 3.2, k + 4));
      limb.flexion = 1.0 + 0.8 * wave(share, 5.3, k + 5);
      limb.girdle =
          about_y(0.08 * wave(share, 3.5, k)) * about_z(0.1 * wave(share, 4.4, k + 1));
      limb.twist = 0.3 * wave(share, 4.2, k + 6);
      limb.end = about_y(0.3 * wave(share, 4.0, k + 1));
    } else {
      limb.upper = about_x(-0.4 + 0.5 * wave(share, 4.5, k)) *
                   about_y(0.2 * wave(share, 3.4, k + 1)) *
                   about_z(side * (0.15 + 0.2 * wave(share, 3.8, k + 2)));
      limb.flexion = 0.8 + 0.6 * wave(share, 5.3, k + 3);
      limb.twist = 0.04 * wave(share, 4.2, k + 4);
      limb.end = about_x(0.3 * wave(share, 4.3, k + 5));
    }
  }
  return place_of(body, floor_m, 0.03 * body.stature_m, a);
}

}  // namespace marey::calib
