// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/adapter_bodies.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/resolve_segment.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/quadruped.h"

namespace marey::retarget {
namespace {

constexpr double kLongAfter_s = 1e3;

Character made(const Skeleton& skeleton, bool with_limits, bool with_bag) {
  CharacterTraits traits;
  traits.has_limits = with_limits;
  if (with_bag) traits.loads.push_back({"bag", {"leftHand", glm::dvec3(0, -0.1, 0)}, 10});
  auto character = make_character("test", skeleton, mapped(skeleton), traits);
  EXPECT_TRUE(character) << (character ? "" : character.error().message());
  return *std::move(character);
}

// Each axis as JointLimit has it: tangents of quarter angles (see
// adapt_limits.h).
glm::dvec3 axis_angles(const JointLimit& limit,
                       const glm::dquat& rest,
                       const glm::dquat& parent_from_joint) {
  const glm::dquat& t = limit.t_pose_from_joint;
  glm::dquat turned = t * (glm::conjugate(rest) * parent_from_joint) * glm::conjugate(t);
  if (turned.w < 0.0) turned = -turned;
  const glm::dvec3 v = glm::dvec3(turned.x, turned.y, turned.z) / (1.0 + turned.w);
  return 4.0 * glm::atan(v);
}

glm::dquat from_axis_angles(const JointLimit& limit,
                            const glm::dquat& rest,
                            const glm::dvec3& angles_rad) {
  const glm::dvec3 v = glm::tan(angles_rad / 4.0);
  const double square = glm::dot(v, v);
  const glm::dvec3 sine = 2.0 / (1.0 + square) * v;
  const glm::dquat turned((1.0 - square) / (1.0 + square), sine.x, sine.y, sine.z);
  const glm::dquat& t = limit.t_pose_from_joint;
  return rest * (glm::conjugate(t) * turned * t);
}

void keep_within_limits(const Character& character, Pose& pose) {
  for (const JointLimit& limit : character.limits) {
    glm::dquat& q = pose.parent_from_joint[index(limit.joint)];
    const glm::dquat& rest = character.skeleton[limit.joint].parent_from_joint.rotation;
    const glm::dvec3 angles = axis_angles(limit, rest, q);
    const glm::dvec3 kept = glm::clamp(angles, limit.min_rad, limit.max_rad);
    if (kept != angles) q = from_axis_angles(limit, rest, kept);
  }
}

void bend_limbs(const Character& character, Pose& pose, double angle_rad) {
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      if (part.kind != PartKind::kLimb) continue;
      pose.parent_from_joint[index(part.joints[1])] =
          glm::angleAxis(angle_rad, part.hinge_in_upper);
    }
  }
}

}  // namespace

Character human(bool with_limits, double stature_m) {
  return made(make_humanoid(average_proportions(stature_m)), with_limits, true);
}

Character human_of(const Skeleton& skeleton, bool with_limits) {
  return made(skeleton, with_limits, false);
}

std::vector<Character> bodies() {
  return {human(false), human(true), testing::make_quadruped()};
}

Limb limb_of(const Character& character, std::size_t joint) {
  for (; joint > 0; joint = index(*character.skeleton.joints[joint].parent)) {
    for (const BodyGroup& group : character.groups) {
      for (const BodyPart& part : group.parts) {
        if (part.kind != PartKind::kLimb) continue;
        const Limb limb{index(part.joints[0]),
                        index(part.joints[1]),
                        index(part.joints[2]),
                        part.hinge_in_upper};
        if (joint == limb.upper || joint == limb.lower || joint == limb.end) return limb;
      }
    }
  }
  ADD_FAILURE() << "on no limb";
  return {};
}

std::size_t joint_at(const Character& character, std::string_view segment) {
  const auto joint = resolve_segment(character.skeleton, segment);
  EXPECT_TRUE(joint) << segment;
  return index(joint.value_or(JointIndex{0}));
}

Pose waiting(const Character& character) {
  Pose pose = rest_pose(character.skeleton);
  bend_limbs(character, pose, 0.4);
  for (const auto& [bone, sign] : {std::pair(HumanBone::kLeftUpperArm, -1.0),
                                   std::pair(HumanBone::kRightUpperArm, 1.0)}) {
    const auto arm = character.skeleton.find(bone);
    if (arm) {
      pose.parent_from_joint[index(*arm)] =
          glm::angleAxis(sign * 1.2, glm::dvec3(0, 0, 1));
    }
  }
  for (const HumanBone bone : {HumanBone::kLeftUpperLeg, HumanBone::kRightUpperLeg}) {
    const auto leg = character.skeleton.find(bone);
    if (leg) {
      pose.parent_from_joint[index(*leg)] = glm::angleAxis(-0.2, glm::dvec3(1, 0, 0));
    }
  }
  keep_within_limits(character, pose);
  return pose;
}

Pose random_posture(const Character& character, Dice& dice, double max_rad) {
  Pose pose = rest_pose(character.skeleton);
  pose.root_in_world +=
      glm::dvec3(dice.between(-2, 2), dice.between(-0.1, 0.1), dice.between(-2, 2));
  pose.parent_from_joint[0] =
      glm::angleAxis(dice.between(-3, 3), glm::dvec3(0, 1, 0)) * dice.turn(0.3);
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      for (const JointIndex j : part.joints) {
        if (index(j) == 0) continue;
        const bool middle = part.kind == PartKind::kLimb && j == part.joints[1];
        pose.parent_from_joint[index(j)] =
            middle ? glm::angleAxis(dice.between(0.15, 1.7), part.hinge_in_upper)
                   : dice.turn(part.kind == PartKind::kSection ? 0.3 * max_rad : max_rad);
      }
    }
  }
  keep_within_limits(character, pose);
  return pose;
}

Constraint contact(const std::string& id,
                   const std::string& segment,
                   const glm::dvec3& p_in_world,
                   const glm::dvec3& offset_in_t_pose,
                   double importance) {
  Constraint c;
  c.id = id;
  c.point = {segment, offset_in_t_pose};
  c.goal = DistanceToPoint{0.0, p_in_world};
  c.importance = importance;
  return c;
}

Constraint standing(const std::string& id, const std::string& segment) {
  Constraint c;
  c.id = id;
  c.point.segment = segment;
  c.goal = Support{};
  return c;
}

Adapter make_adapter(const Character& character,
                     const ConstraintSet& constraints,
                     const AdaptOptions& options) {
  auto adapter = Adapter::make(character, constraints, options);
  EXPECT_TRUE(adapter) << (adapter ? "" : adapter.error().message());
  return *std::move(adapter);
}

Adapted adapted(const Character& character,
                const ConstraintSet& constraints,
                const Pose& reference,
                const AdaptOptions& options) {
  Adapter adapter = make_adapter(character, constraints, options);
  Adapted out;
  out.report = adapter.adapt(reference, kLongAfter_s, out.pose);
  return out;
}

glm::dvec3 place_of(const Character& character,
                    const Pose& pose,
                    const BodyPoint& point) {
  const auto frames = world_from_joints(character.skeleton, pose);
  return frames[joint_at(character, point.segment)] * point.offset_in_t_pose;
}

double target_distance_m(const Character& character,
                         const Pose& pose,
                         const Constraint& constraint) {
  return glm::distance(place_of(character, pose, constraint.point),
                       std::get<DistanceToPoint>(constraint.goal).p_in_world);
}

glm::dquat rotation_of(const Character& character,
                       const Pose& pose,
                       std::string_view segment) {
  return world_from_joints(character.skeleton, pose)[joint_at(character, segment)]
      .rotation;
}

glm::dvec3 centre_of_mass(const Character& character, const Pose& pose, bool loaded) {
  const auto frames = world_from_joints(character.skeleton, pose);
  glm::dvec3 moment(0.0);
  double mass_kg = 0.0;
  const auto add = [&](const PointMass& mass) {
    moment += mass.mass_kg * (frames[index(mass.joint)] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  };
  for (const PointMass& mass : character.masses) add(mass);
  for (const Load& load : character.loads) {
    if (loaded) add(load.mass);
  }
  return moment / mass_kg;
}

double furthest_m(const Character& character, const Pose& a, const Pose& b) {
  const auto in_a = world_from_joints(character.skeleton, a);
  const auto in_b = world_from_joints(character.skeleton, b);
  double furthest = 0.0;
  for (std::size_t j = 0; j < in_a.size(); ++j) {
    furthest =
        std::max(furthest, glm::distance(in_a[j].translation, in_b[j].translation));
  }
  return furthest;
}

double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::normalize(glm::conjugate(a) * b)));
}

double max_turned_rad(const Pose& a, const Pose& b) {
  double maximum = 0.0;
  for (std::size_t j = 0; j < a.parent_from_joint.size(); ++j) {
    maximum = std::max(maximum,
                       angle_between_rad(a.parent_from_joint[j], b.parent_from_joint[j]));
  }
  return maximum;
}

double beyond_limits_rad(const Character& character,
                         const Pose& pose,
                         const std::vector<std::size_t>& free) {
  double maximum = 0.0;
  for (const JointLimit& limit : character.limits) {
    if (std::find(free.begin(), free.end(), index(limit.joint)) != free.end()) continue;
    const glm::dvec3 angles =
        axis_angles(limit,
                    character.skeleton[limit.joint].parent_from_joint.rotation,
                    pose.parent_from_joint[index(limit.joint)]);
    const glm::dvec3 over = glm::max(angles - limit.max_rad, limit.min_rad - angles);
    maximum = std::max({maximum, over.x, over.y, over.z});
  }
  return maximum;
}

bool is_finite(const Pose& pose) {
  bool finite = true;
  const auto check = [&](double x) { finite = finite && std::isfinite(x); };
  for (int i = 0; i < 3; ++i) check(pose.root_in_world[i]);
  for (const glm::dquat& q : pose.parent_from_joint) {
    check(q.w);
    check(q.x);
    check(q.y);
    check(q.z);
  }
  return finite;
}

bool same_bits(const Pose& a, const Pose& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  bool all = a.parent_from_joint.size() == b.parent_from_joint.size();
  for (int i = 0; i < 3; ++i) all = all && same(a.root_in_world[i], b.root_in_world[i]);
  for (std::size_t j = 0; all && j < a.parent_from_joint.size(); ++j) {
    const glm::dquat& p = a.parent_from_joint[j];
    const glm::dquat& q = b.parent_from_joint[j];
    all = same(p.w, q.w) && same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z);
  }
  return all;
}
}  // namespace marey::retarget
