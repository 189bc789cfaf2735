// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt_numbers.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/assert.h"

namespace marey::retarget {
namespace {

double length_of_limb(const Skeleton& skeleton, const LimbPlan& limb) {
  const auto bone = [&](int joint) {
    return glm::length(
        skeleton.joints[static_cast<std::size_t>(joint)].parent_from_joint.translation);
  };
  return bone(limb.lower) + bone(limb.end);
}

// A leg's length, else any limb's, else the longest way from the root.
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

// Quarter angles: a half turn is 1, and a little more is as good as no limit.
float quarter_tangent(double angle_rad) {
  return static_cast<float>(std::tan(std::clamp(angle_rad, -3.2, 3.2) / 4.0));
}

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

BodyNumbers body_numbers(const Character& character, const Plan& plan) {
  BodyNumbers body;
  body.unit_m = unit_of(character.skeleton, plan);
  const double per_unit = 1.0 / body.unit_m;
  for (const Joint& joint : character.skeleton.joints) {
    body.offset.push_back(lanes<float>(joint.parent_from_joint.translation * per_unit));
  }
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      if (part.kind != PartKind::kLimb) continue;
      body.hinge.push_back(lanes<float>(part.hinge_in_upper));
    }
  }
  const auto add_mass = [&](const PointMass& mass, bool counts) {
    body.mass.push_back(counts ? static_cast<float>(mass.mass_kg) : 0.0F);
    body.mass_in_joint.push_back(lanes<float>(mass.p_in_joint * per_unit));
  };
  for (const PointMass& mass : character.masses) add_mass(mass, true);
  for (const Load& load : character.loads) add_mass(load.mass, true);
  for (const JointLimit& limit : character.limits) {
    body.limit_from_joint.push_back(lanes<float>(limit.t_pose_from_joint));
    body.rest_from_joint.push_back(
        lanes<float>(character.skeleton[limit.joint].parent_from_joint.rotation));
    body.limit_min.push_back({quarter_tangent(limit.min_rad.x),
                              quarter_tangent(limit.min_rad.y),
                              quarter_tangent(limit.min_rad.z)});
    body.limit_max.push_back({quarter_tangent(limit.max_rad.x),
                              quarter_tangent(limit.max_rad.y),
                              quarter_tangent(limit.max_rad.z)});
  }
  const Flexibility& flexibility = character.flexibility;
  body.least_trunk_thigh_cos =
      flexibility.least_trunk_thigh_angle_rad > 0.0
          ? static_cast<float>(std::cos(flexibility.least_trunk_thigh_angle_rad))
          : 2.0F;
  body.straight_knee_cos = static_cast<float>(std::cos(flexibility.straight_knee_rad));
  return body;
}

void read_posture(const Plan& plan,
                  const BodyNumbers& body,
                  const Pose& pose,
                  bool balance,
                  PostureNumbers& out) {
  const std::size_t n = plan.parent.size();
  MAREY_ASSERT(pose.parent_from_joint.size() == n);
  out.parent_from_joint.resize(n);
  out.rotation.resize(n);
  out.place.resize(n);
  out.carried_mass.resize(n);
  out.carried_in_joint.resize(n);
  out.origin_in_world = pose.root_in_world;
  for (std::size_t j = 0; j < n; ++j) {
    const Quat<float> local = lanes<float>(pose.parent_from_joint[j]);
    out.parent_from_joint[j] = local;
    if (plan.parent[j] < 0) {
      out.rotation[j] = local;
      out.place[j] = {0.0F, 0.0F, 0.0F};
      continue;
    }
    const auto p = static_cast<std::size_t>(plan.parent[j]);
    out.rotation[j] = out.rotation[p] * local;
    out.place[j] = out.place[p] + rotate(out.rotation[p], body.offset[j]);
  }
  if (!balance) return;
  for (std::size_t j = 0; j < n; ++j) {
    out.carried_mass[j] = 0.0F;
    out.carried_in_joint[j] = {0.0F, 0.0F, 0.0F};
  }
  float total = 0.0F;
  for (std::size_t m = 0; m < plan.masses.size(); ++m) {
    const auto j = static_cast<std::size_t>(plan.masses[m].joint);
    const auto c = static_cast<std::size_t>(plan.masses[m].carried_by);
    Vec3<float> in_carrier = body.mass_in_joint[m];
    if (c != j) {
      const Vec3<float> at = out.place[j] + rotate(out.rotation[j], in_carrier);
      in_carrier = rotate(conjugate(out.rotation[c]), at - out.place[c]);
    }
    out.carried_mass[c] += body.mass[m];
    out.carried_in_joint[c] += body.mass[m] * in_carrier;
    total += body.mass[m];
  }
  for (std::size_t j = 0; j < n; ++j) {
    if (out.carried_mass[j] <= 0.0F) continue;
    out.carried_in_joint[j] = (1.0F / out.carried_mass[j]) * out.carried_in_joint[j];
    out.carried_mass[j] /= total;
  }
}

}  // namespace marey::retarget
