// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/kernel/adapt_load.h"
#include "retarget/adapt/kernel/thesis_solve.h"
#include "retarget/adapt/plan/adapt_numbers.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/resolve_segment.h"
#include "tests/retarget/adapter_bodies.h"
#include "tests/retarget/mapped.h"

namespace marey::retarget {

/// An average human without joint limits, 70 kg.
inline Character thesis_human(double min_trunk_thigh_angle_rad = 0.0) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  CharacterTraits traits;
  traits.has_limits = false;
  // Table 5.1, used for all figures of the thesis.
  traits.mass.table = MassTable::kDempster;
  traits.flexibility.min_trunk_thigh_angle_rad = min_trunk_thigh_angle_rad;
  traits.loads.push_back({"bag", {"leftHand", glm::dvec3(0.0)}, 10.0});
  auto character = make_character("human", skeleton, mapped(skeleton), traits);
  EXPECT_TRUE(character) << (character ? "" : character.error().message());
  return *std::move(character);
}

/// Arms hang, elbows and knees are bent by 0.3 rad, the feet are in place.
inline Pose standing_pose(const Character& character, double knee_rad = 0.3) {
  Pose pose = rest_pose(character.skeleton);
  const auto turn = [&](HumanBone bone, double angle_rad, const glm::dvec3& axis) {
    const auto joint = character.skeleton.find(bone);
    pose.parent_from_joint[index(*joint)] = glm::angleAxis(angle_rad, axis);
  };
  using B = HumanBone;
  turn(B::kLeftUpperArm, -1.3, {0, 0, 1});
  turn(B::kRightUpperArm, 1.3, {0, 0, 1});
  turn(B::kLeftLowerArm, -0.3, {0, 1, 0});
  turn(B::kRightLowerArm, 0.3, {0, 1, 0});
  for (const B bone : {B::kLeftUpperLeg, B::kRightUpperLeg}) {
    turn(bone, -0.5 * knee_rad, {1, 0, 0});
  }
  for (const B bone : {B::kLeftLowerLeg, B::kRightLowerLeg})
    turn(bone, knee_rad, {1, 0, 0});
  for (const B bone : {B::kLeftFoot, B::kRightFoot})
    turn(bone, -0.5 * knee_rad, {1, 0, 0});
  return pose;
}

inline glm::dvec3 place_in_world(const Character& character,
                                 const Pose& pose,
                                 const std::string& segment) {
  const auto joint = resolve_segment(character.skeleton, segment);
  EXPECT_TRUE(joint) << segment;
  return world_from_joints(character.skeleton, pose)[index(*joint)].translation;
}

inline glm::dvec3 centre_of_mass_of(const Character& character, const Pose& pose) {
  const auto world = world_from_joints(character.skeleton, pose);
  glm::dvec3 moment(0.0);
  double mass_kg = 0.0;
  for (const PointMass& mass : character.masses) {
    moment += mass.mass_kg * (world[index(mass.joint)] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  }
  return moment / mass_kg;
}

inline Constraint contact_of(const std::string& segment, const glm::dvec3& p_in_world) {
  Constraint out;
  out.id = segment;
  out.point.segment = segment;
  out.goal = DistanceToPoint{0.0, p_in_world};
  return out;
}

inline Constraint support_of(const std::string& segment) {
  Constraint out;
  out.id = segment;
  out.point.segment = segment;
  out.goal = Support{};
  return out;
}

inline AdaptOptions by_the_thesis(BalanceMode balance = BalanceMode::kOff) {
  AdaptOptions options;
  options.method = Method::kThesis;
  options.balance = balance;
  return options;
}

/// One lane in double, loaded as by the adapter; all targets are active.
struct ThesisLane {
  Character character;
  Plan plan;
  ThesisShape shape;
  BodyNumbers body;
  SolveSettings settings;
  Lanes<double> lanes;
  Solve<double> solve;

  ThesisLane(const Character& of,
             const ConstraintSet& constraints,
             const Pose& reference,
             BalanceMode balance = BalanceMode::kOff,
             const glm::dvec3& com_in_world = glm::dvec3(0.0))
      : character(of),
        plan(make_plan(character, constraints, balance != BalanceMode::kOff)),
        shape{make_thesis_plan(plan), balance != BalanceMode::kOff},
        body(body_numbers(character, plan)),
        lanes(plan) {
    const bool balanced = balance != BalanceMode::kOff;
    load_body(plan, body.packed.data(), 0, lanes);
    std::vector<float> posture(4 * plan.parent.size());
    pack_posture(reference, posture);
    load_posture(plan, posture.data(), 0, lanes);
    BalanceNumbers wanted;
    wanted.wanted = balanced;
    wanted.vertical = balance == BalanceMode::k3d;
    wanted.from_reference = false;
    wanted.com_in_world = com_in_world;
    std::vector<float> packed_balance(kBalanceNumbers);
    pack_balance(body, reference.root_in_world, wanted, packed_balance);
    load_balance(packed_balance.data(), 0, lanes);
    std::vector<TargetNumbers> targets(plan.points.size());
    for (std::size_t k = 0; k < targets.size(); ++k) {
      const auto c = static_cast<std::size_t>(plan.points[k].constraint);
      const Constraint& constraint = constraints.constraints[c];
      const auto* contact = std::get_if<DistanceToPoint>(&constraint.goal);
      const auto* support = std::get_if<Support>(&constraint.goal);
      targets[k].in_joint = constraint.point.offset_in_t_pose;
      if (contact != nullptr) targets[k].a_in_world = contact->p_in_world;
      if (support != nullptr) targets[k].a_in_world = *support->footprint_in_world;
      targets[k].active = true;
      targets[k].weight = constraint.importance;
      targets[k].precision_m = constraint.precision_m;
    }
    std::vector<float> packed(kNumbersPerTarget * targets.size());
    pack_targets(plan, body, reference.root_in_world, targets, packed);
    load_targets(plan, packed.data(), 0, lanes);
    stand_reference(plan, balanced, true, lanes);
    set_axes(plan, true, lanes);
    take_posture(lanes.reference_rotation, lanes.reference_place, plan, true, lanes);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      measure_target(plan, static_cast<int>(k), lanes);
    }
    if (balanced) measure_balance(plan, lanes);
  }

  [[nodiscard]] std::size_t joint(const std::string& segment) const {
    return index(*resolve_segment(character.skeleton, segment));
  }
  [[nodiscard]] const ThesisTurn& turn_of(const std::string& segment) const {
    for (const ThesisTurn& turn : shape.groups.turns) {
      if (turn.joints.back() == static_cast<int>(joint(segment))) return turn;
    }
    ADD_FAILURE() << "nothing turns " << segment;
    return shape.groups.turns.front();
  }
  /// Returns the group with this root joint.
  [[nodiscard]] const KineticGroup& balancing(const std::string& segment) const {
    for (const KineticGroup& group : shape.groups.balancing) {
      if (group.root == static_cast<int>(joint(segment))) return group;
    }
    ADD_FAILURE() << "nothing balances with " << segment;
    return shape.groups.balancing.front();
  }
};

inline glm::dvec3 glm_of(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}
inline Vec3<double> vec_of(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace marey::retarget
