// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/plan/adapt_numbers.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::retarget {
namespace {

double length_of_limb(const Skeleton& skeleton, const LimbPlan& limb) {
  const auto bone = [&](int joint) {
    return glm::length(
        skeleton.joints[static_cast<std::size_t>(joint)].parent_from_joint.translation);
  };
  return bone(limb.lower) + bone(limb.end);
}

double unit_of(const Skeleton& skeleton, const Plan& plan) {
  double legs = 0.0;
  double limbs = 0.0;
  int leg_count = 0;
  for (const LimbPlan& limb : plan.limbs) {
    const double length = length_of_limb(skeleton, limb);
    limbs += length;
    if (!limb.can_support) continue;
    legs += length;
    ++leg_count;
  }
  if (leg_count > 0) return legs / leg_count;
  if (!plan.limbs.empty()) return limbs / static_cast<double>(plan.limbs.size());
  double longest = 0.0;
  std::vector<double> way(skeleton.joints.size(), 0.0);
  for (std::size_t j = 1; j < way.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    way[j] = way[index(*joint.parent)] + glm::length(joint.parent_from_joint.translation);
    longest = std::max(longest, way[j]);
  }
  return longest > 0.0 ? longest : 1.0;
}

// Tangent of the quarter angle: a half turn is 1, and more is equivalent to no limit.
double quarter_tangent(double angle_rad) {
  return std::tan(std::clamp(angle_rad, -3.2, 3.2) / 4.0);
}

// Larger distances are treated as infinite; the square of this one is finite.
constexpr double kMaxDistance = 1e6;

/// Writes consecutive numbers.
class Packer {
 public:
  explicit Packer(std::span<float> out) : out_(out) {}
  void put(double x) {
    out_[next_++] = static_cast<float>(std::clamp(x, -kMaxDistance, kMaxDistance));
  }
  void put(const glm::dvec3& v) {
    put(v.x);
    put(v.y);
    put(v.z);
  }
  void put(const glm::dquat& q) {
    put(q.w);
    put(q.x);
    put(q.y);
    put(q.z);
  }
  void put(bool flag) { put(flag ? 1.0 : 0.0); }
  [[nodiscard]] std::size_t count() const { return next_; }

 private:
  std::span<float> out_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<glm::dquat> t_pose_rotations(const Character& character) {
  if (!character.t_pose_from_joint.empty()) return character.t_pose_from_joint;
  std::vector<glm::dquat> out;
  for (const RigidTransform& t :
       world_from_joints(character.skeleton, rest_pose(character.skeleton))) {
    out.push_back(t.rotation);
  }
  return out;
}

std::size_t body_number_count(const Plan& plan) {
  return 3 * plan.parent.size() + 3 * plan.limbs.size() + 14 * plan.limited.size() +
         4 * plan.masses.size() + 2;
}

BodyNumbers body_numbers(const Character& character, const Plan& plan) {
  BodyNumbers body;
  body.unit_m = unit_of(character.skeleton, plan);
  const double per_unit = 1.0 / body.unit_m;
  body.packed.resize(body_number_count(plan));
  const std::vector<glm::dquat> t_pose = t_pose_rotations(character);
  Packer pack(body.packed);
  for (const Joint& joint : character.skeleton.joints) {
    pack.put(joint.parent_from_joint.translation * per_unit);
  }
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      if (part.kind == PartKind::kLimb) pack.put(part.hinge_in_upper);
    }
  }
  for (const JointLimit& limit : character.limits) {
    const std::optional<JointIndex> parent = character.skeleton[limit.joint].parent;
    const glm::dquat& own = t_pose[index(limit.joint)];
    pack.put(limit.t_pose_from_joint);
    pack.put(parent ? glm::conjugate(t_pose[index(*parent)]) * own : own);
    for (int a = 0; a < 3; ++a) pack.put(quarter_tangent(limit.min_rad[a]));
    for (int a = 0; a < 3; ++a) pack.put(quarter_tangent(limit.max_rad[a]));
  }
  const Flexibility& flexibility = character.flexibility;
  const double min_angle = flexibility.min_trunk_thigh_angle_rad;
  pack.put(min_angle > 0.0 ? std::cos(min_angle) : 2.0);
  pack.put(std::cos(flexibility.straight_knee_rad));
  body.masses_at = pack.count();
  const auto add_mass = [&](const PointMass& mass) {
    pack.put(mass.mass_kg);
    pack.put(mass.p_in_joint * per_unit);
  };
  for (const PointMass& mass : character.masses) add_mass(mass);
  for (const Load& load : character.loads) add_mass(load.mass);
  MAREY_ASSERT(pack.count() == body.packed.size());
  return body;
}

void pack_posture(const Pose& pose, std::span<float> out) {
  MAREY_ASSERT(out.size() == 4 * pose.parent_from_joint.size());
  Packer pack(out);
  for (const glm::dquat& q : pose.parent_from_joint) pack.put(q);
}

void pack_targets(const Plan& plan,
                  double unit_m,
                  const glm::dvec3& origin_in_world,
                  std::span<const TargetNumbers> targets,
                  std::span<float> out) {
  MAREY_ASSERT(out.size() == kNumbersPerTarget * targets.size());
  const double per_unit = 1.0 / unit_m;
  Packer pack(out);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const TargetNumbers& target = targets[k];
    const bool other = plan.points[k].goal == GoalKind::kDistanceToOther;
    pack.put(target.in_joint * per_unit);
    pack.put((target.a_in_world - origin_in_world) * per_unit);
    pack.put((other ? target.b : target.b - origin_in_world) * per_unit);
    pack.put(target.world_from_joint);
    pack.put(target.distance_m * per_unit);
    pack.put(target.active);
    pack.put(target.weight);
    // Precisions below the resolution of single precision cannot be reached.
    pack.put(1.0 / std::max(target.precision_m * per_unit, 2e-6));
  }
}

void pack_balance(double unit_m,
                  const glm::dvec3& origin_in_world,
                  const BalanceNumbers& balance,
                  std::span<float> out) {
  MAREY_ASSERT(out.size() == kBalanceNumbers);
  Packer pack(out);
  pack.put(balance.wanted);
  pack.put(balance.vertical);
  pack.put(std::max(balance.precision_m / unit_m, 2e-6));
  pack.put(balance.root_weight);
  pack.put(balance.root_weight_on_floor);
  pack.put(balance.from_reference);
  pack.put((balance.com_in_world - origin_in_world) / unit_m);
  pack.put(balance.constraint_threshold_m / unit_m);
  pack.put(balance.balance_threshold_m / unit_m);
}

}  // namespace marey::retarget
