// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/place_masses.h"

#include <algorithm>
#include <array>
#include <optional>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "retarget/body/anthropometry.h"
#include "retarget/body/foot_shape.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/body/segment_inertia.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// Lengths that a skeleton may lack, in leg lengths, after average_proportions().
constexpr std::array<double, 3> kArmInLegs{0.379, 0.297, 0.220};
constexpr double kVertexFromHeadInLegs = 0.234;
constexpr double kTrunkInLegs = 0.611;
// Height of the shoulder centres over that of the base of the neck, both from the hip
// centres, after average_proportions().
constexpr double kShouldersInTrunk = 0.883;
// The ear canal, between the base of the skull and the vertex.
constexpr double kEarInHead = 1.0 / 3.0;
// The third knuckle, between wrist and finger tip: de Leva's WJC-MET3 over WJC-DAC3.
constexpr double kKnuckleInHand = 0.459;

struct Placed {
  JointIndex joint{};
  glm::dvec3 p_in_joint{0.0};
  glm::dmat3 inertia_per_kg_m2{0.0};
};

// Transverse axes of the anatomical position as they are in the T-pose: that of the upper
// arm is the elbow's hinge, that of forearm and hand is in the palm, which faces down.
constexpr glm::dvec3 kTransverse{1.0, 0.0, 0.0};
constexpr glm::dvec3 kTransverseOfUpperArm{0.0, 1.0, 0.0};
constexpr glm::dvec3 kTransverseOfHand{0.0, 0.0, 1.0};

struct Rest {
  const Skeleton& skeleton;
  const BodyMap& map;
  const SegmentTable& table;
  bool dempster;
  std::vector<RigidTransform> world_from_joint;

  [[nodiscard]] std::optional<JointIndex> joint(B bone) const {
    return map.joint_of[index(bone)];
  }
  [[nodiscard]] glm::dvec3 place(JointIndex j) const {
    return world_from_joint[index(j)].translation;
  }
  [[nodiscard]] Placed on(JointIndex j, const glm::dvec3& p_in_world) const {
    return {j, inverse(world_from_joint[index(j)]) * p_in_world};
  }
  // The inertia of a segment of that extent in the world, in world axes.
  [[nodiscard]] glm::dmat3 inertia(const GyrationRadii& radii,
                                   JointIndex j,
                                   const glm::dvec3& along_m,
                                   const glm::dvec3& transverse_in_t_pose) const {
    return inertia_per_kg(
        radii,
        {along_m, rotation_from_t_pose(map, world_from_joint, j) * transverse_in_t_pose});
  }
  // The same inertia in the axes of the joint's frame.
  [[nodiscard]] glm::dmat3 in_joint(JointIndex j, const glm::dmat3& in_world) const {
    const glm::dmat3 turn = glm::mat3_cast(world_from_joint[index(j)].rotation);
    return glm::transpose(turn) * in_world * turn;
  }
  [[nodiscard]] Placed segment(const SegmentRow& row,
                               JointIndex j,
                               const glm::dvec3& com_in_world,
                               const glm::dvec3& along_m,
                               const glm::dvec3& transverse_in_t_pose) const {
    Placed out = on(j, com_in_world);
    out.inertia_per_kg_m2 =
        in_joint(j, inertia(row.gyration, j, along_m, transverse_in_t_pose));
    return out;
  }
  [[nodiscard]] std::optional<glm::dvec3> tip(JointIndex j) const {
    const auto& tip = skeleton[j].tip_in_joint;
    if (!tip) return std::nullopt;
    return world_from_joint[index(j)] * *tip;
  }
};

std::vector<JointIndex> trunk_joints(const BodyMap& map) {
  std::vector<JointIndex> joints{map.hips()};
  for (const SpineSection* section : {&map.abdomen, &map.torso}) {
    for (int i = 0; i < section->count; ++i) {
      joints.push_back(section->joints[static_cast<std::size_t>(i)]);
    }
  }
  return joints;
}

glm::dvec3 mid_hip(const Rest& rest) {
  return 0.5 * (rest.place(rest.map.leg(0).upper) + rest.place(rest.map.leg(1).upper));
}

glm::dvec3 neck_base(const Rest& rest) {
  if (const auto neck = rest.joint(B::kNeck)) return rest.place(*neck);
  if (const auto head = rest.joint(B::kHead)) return rest.place(*head);
  const JointIndex top = trunk_joints(rest.map).back();
  if (const auto tip = rest.tip(top); tip && top != rest.map.hips()) return *tip;
  const glm::dvec3 guess =
      mid_hip(rest) + glm::dvec3(0, kTrunkInLegs * rest.map.leg_length_m, 0);
  return {guess.x, std::max(guess.y, rest.place(top).y), guess.z};
}

// Between the shoulder centres.
glm::dvec3 mid_shoulder(const Rest& rest) {
  const glm::dvec3 hips = mid_hip(rest);
  const auto left = rest.joint(B::kLeftUpperArm);
  const auto right = rest.joint(B::kRightUpperArm);
  return left && right ? 0.5 * (rest.place(*left) + rest.place(*right))
                       : hips + kShouldersInTrunk * (neck_base(rest) - hips);
}

// Share of the trunk's mass below a share of its height.
double trunk_mass_below(const SegmentTable& t, double height) {
  if (height <= t.lower_height) return t.lower_mass * height / t.lower_height;
  if (height <= t.middle_height) {
    return t.lower_mass + (t.middle_mass - t.lower_mass) * (height - t.lower_height) /
                              (t.middle_height - t.lower_height);
  }
  return t.middle_mass +
         (1.0 - t.middle_mass) * (height - t.middle_height) / (1.0 - t.middle_height);
}

void add_trunk(const Rest& rest, double mass_kg, std::vector<PointMass>& out) {
  const std::vector<JointIndex> joints = trunk_joints(rest.map);
  const glm::dvec3 bottom = mid_hip(rest);
  const glm::dvec3 top = neck_base(rest);
  const glm::dvec3 up = top - bottom;
  const double squared = std::max(glm::dot(up, up), 1e-12);
  std::vector<double> shares;
  std::vector<glm::dvec3> middles;
  const glm::dvec3 along = mid_shoulder(rest) - bottom;
  const glm::dvec3 centre = bottom + rest.table.trunk.com_at * along;
  glm::dvec3 off = centre;
  double height = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const bool last = i + 1 == joints.size();
    const glm::dvec3 from = i == 0 ? bottom : rest.place(joints[i]);
    const glm::dvec3 to = last ? top : rest.place(joints[i + 1]);
    const double reached =
        last ? 1.0 : std::clamp(glm::dot(to - bottom, up) / squared, height, 1.0);
    shares.push_back(trunk_mass_below(rest.table, reached) -
                     trunk_mass_below(rest.table, height));
    middles.push_back(0.5 * (from + to));
    off -= shares.back() * middles.back();
    height = reached;
  }
  // All shift by the same amount, so that their common centre is the table's trunk
  // centre.
  std::vector<SegmentPart> parts;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    parts.push_back({shares[i], middles[i] + off - centre});
  }
  const glm::dmat3 inertia = part_inertia_per_kg(
      rest.inertia(rest.table.trunk.gyration, rest.map.hips(), along, kTransverse),
      parts);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (shares[i] <= 0.0) continue;
    const Placed at = rest.on(joints[i], middles[i] + off);
    out.push_back({at.joint,
                   at.p_in_joint,
                   shares[i] * mass_kg,
                   rest.in_joint(joints[i], inertia)});
  }
}

Placed head_com(const Rest& rest) {
  const auto head = rest.joint(B::kHead);
  const auto neck = rest.joint(B::kNeck);
  const JointIndex carrier = head ? *head : neck.value_or(trunk_joints(rest.map).back());
  const glm::dvec3 base = neck_base(rest);
  const glm::dvec3 skull = head ? rest.place(*head) : base;
  const glm::dvec3 guess =
      skull + glm::dvec3(0, kVertexFromHeadInLegs * rest.map.leg_length_m, 0);
  const glm::dvec3 vertex = head ? rest.tip(*head).value_or(guess) : guess;
  const glm::dvec3 end = rest.dempster ? skull + kEarInHead * (vertex - skull) : vertex;
  return rest.segment(rest.table.head,
                      carrier,
                      base + rest.table.head.com_at * (end - base),
                      vertex - base,
                      kTransverse);
}

// Upper arm, forearm and hand.
std::array<Placed, 3> arm_coms(const Rest& rest, int side) {
  const bool left = side == 0;
  const std::array<B, 3> bones =
      left ? std::array<B, 3>{B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand}
           : std::array<B, 3>{B::kRightUpperArm, B::kRightLowerArm, B::kRightHand};
  const auto clavicle = rest.joint(left ? B::kLeftShoulder : B::kRightShoulder);
  JointIndex carrier = clavicle.value_or(trunk_joints(rest.map).back());
  glm::dvec3 along(left ? 1.0 : -1.0, 0.0, 0.0);
  glm::dvec3 from = clavicle ? rest.place(*clavicle) : neck_base(rest);
  const SegmentTable& t = rest.table;
  std::array<SegmentRow, 3> rows{t.upper_arm, t.forearm, t.hand};
  if (rest.dempster) rows[2].com_at *= kKnuckleInHand;
  constexpr std::array kTransverses{
      kTransverseOfUpperArm, kTransverseOfHand, kTransverseOfHand};
  std::array<Placed, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    if (const auto joint = rest.joint(bones[i])) {
      carrier = *joint;
      from = rest.place(*joint);
    }
    glm::dvec3 to = from + kArmInLegs[i] * rest.map.leg_length_m * along;
    const auto next = i < 2 ? rest.joint(bones[i + 1]) : std::nullopt;
    const auto tip = carrier == rest.joint(bones[i]) ? rest.tip(carrier) : std::nullopt;
    if (next) {
      to = rest.place(*next);
    } else if (tip) {
      to = *tip;
    }
    if (glm::length(to - from) > 1e-9) along = glm::normalize(to - from);
    const glm::dvec3 com = from + rows[i].com_at * (to - from);
    out[i] = rest.segment(rows[i], carrier, com, to - from, kTransverses[i]);
    from = to;
  }
  return out;
}

Placed foot_com(const Rest& rest, int side) {
  const bool left = side == 0;
  const JointIndex ankle = *rest.joint(left ? B::kLeftFoot : B::kRightFoot);
  const glm::dquat& t_pose_from_joint = rest.map.joints[index(ankle)].t_pose_from_joint;
  const FootMap& foot = rest.map.feet[static_cast<std::size_t>(side)];
  glm::dvec3 com = rest.table.foot.com_at * foot.ball_from_ankle_in_t_pose;
  double tip_m = (1.0 + kToesInBall) * foot.ball_from_ankle_in_t_pose.z;
  const auto toes = rest.joint(left ? B::kLeftToes : B::kRightToes);
  if (const auto tip = toes ? rest.tip(*toes) : std::nullopt) {
    tip_m = (t_pose_from_joint * rest.on(ankle, *tip).p_in_joint).z;
  }
  const double heel_m = -kHeelInFoot * tip_m;
  if (!rest.dempster) {
    com = {0.5 * foot.ball_from_ankle_in_t_pose.x,
           -0.5 * foot.ankle_height_m,
           heel_m + rest.table.foot.com_at * (tip_m - heel_m)};
  }
  const glm::dmat3 in_t_pose = inertia_per_kg(
      rest.table.foot.gyration, {glm::dvec3(0.0, 0.0, tip_m - heel_m), kTransverse});
  const glm::dmat3 turn = glm::mat3_cast(t_pose_from_joint);
  return {ankle,
          glm::conjugate(t_pose_from_joint) * com,
          glm::transpose(turn) * in_t_pose * turn};
}

void add_limbs(const Rest& rest,
               const std::array<double, kHumanBoneCount>& kg,
               std::vector<PointMass>& out) {
  const auto add = [&](const Placed& at, B bone) {
    out.push_back({at.joint, at.p_in_joint, kg[index(bone)], at.inertia_per_kg_m2});
  };
  for (int side = 0; side < 2; ++side) {
    const auto bone = [&](B left) { return side == 0 ? left : mirrored(left); };
    const std::array<Placed, 3> arm = arm_coms(rest, side);
    add(arm[0], bone(B::kLeftUpperArm));
    add(arm[1], bone(B::kLeftLowerArm));
    add(arm[2], bone(B::kLeftHand));
    const LimbMap& leg = rest.map.leg(side);
    const auto between = [&](JointIndex a, JointIndex b, const SegmentRow& row) {
      const glm::dvec3 along = rest.place(b) - rest.place(a);
      return rest.segment(row, a, rest.place(a) + row.com_at * along, along, kTransverse);
    };
    add(between(leg.upper, leg.lower, rest.table.thigh), bone(B::kLeftUpperLeg));
    add(between(leg.lower, leg.end, rest.table.shank), bone(B::kLeftLowerLeg));
    add(foot_com(rest, side), bone(B::kLeftFoot));
  }
}

}  // namespace

Result<std::vector<PointMass>> place_masses(const Skeleton& skeleton,
                                            const BodyMap& map,
                                            const MassSpec& spec) {
  const auto kg = weigh_segments(spec);
  if (!kg) return kg.error();
  const Rest rest{skeleton,
                  map,
                  segment_table(spec.table),
                  spec.table == MassTable::kDempster,
                  world_from_joints(skeleton, rest_pose(skeleton))};
  std::vector<PointMass> masses;
  add_trunk(rest, (*kg)[index(B::kHips)], masses);
  const Placed head = head_com(rest);
  masses.push_back(
      {head.joint, head.p_in_joint, (*kg)[index(B::kHead)], head.inertia_per_kg_m2});
  add_limbs(rest, *kg, masses);
  return masses;
}

}  // namespace marey::retarget
