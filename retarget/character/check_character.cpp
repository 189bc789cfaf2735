// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/check_character.h"

#include <cmath>
#include <string>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/pose.h"
#include "retarget/character/check_groups.h"
#include "retarget/constraints/constraint_error.h"

namespace marey::retarget {
namespace {

constexpr double kPi = 3.14159265358979323846;

constexpr double kMaxMass_kg = 1e6;

bool has_finite(double x) {
  return std::isfinite(x);
}
bool has_finite(const glm::dvec3& v) {
  return has_finite(v.x) && has_finite(v.y) && has_finite(v.z);
}
bool is_near(const glm::dvec3& v) {
  return std::abs(v.x) <= kMaxLength_m && std::abs(v.y) <= kMaxLength_m &&
         std::abs(v.z) <= kMaxLength_m;
}
bool is_rotation(const glm::dquat& q) {
  // Also false for NaN.
  return std::abs(glm::dot(q, q) - 1.0) < kRounded;
}
bool is_angle(double rad) {
  return rad >= 0.0 && rad <= kPi;
}

Status check_skeleton(const CharacterCheck& check) {
  const auto& joints = check.character.skeleton.joints;
  if (joints.empty()) {
    return check.refuse("skeleton", "it has no joints", "choose a file with a skeleton");
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string called = check.called(JointIndex{static_cast<int>(i)});
    const auto& parent = joints[i].parent;
    if (parent && (static_cast<int>(*parent) < 0 || index(*parent) >= i)) {
      return check.refuse(
          called, "its parent does not come before it", "sort the joints");
    }
    if (parent.has_value() != (i > 0)) {
      return check.refuse(
          called,
          i > 0 ? "it is a second root" : "it is the first joint but not the root",
          "use one root joint, and list it first");
    }
    if (!has_finite(joints[i].parent_from_joint.translation) ||
        !is_rotation(joints[i].parent_from_joint.rotation)) {
      return check.refuse(called,
                          "its rest pose is not a place and a unit quaternion",
                          "correct its numbers");
    }
    if (!is_near(joints[i].parent_from_joint.translation)) {
      return check.refuse(called,
                          std::string("it rests more than 10 km from ") +
                              (parent ? "its parent" : "the origin"),
                          "give its place in metres");
    }
  }
  const auto& t_pose = check.character.t_pose_from_joint;
  if (!t_pose.empty() && t_pose.size() != joints.size()) {
    return check.refuse("T-pose",
                        "it has " + std::to_string(t_pose.size()) + " rotations for " +
                            std::to_string(joints.size()) + " joints",
                        "give one per joint, or none");
  }
  for (std::size_t i = 0; i < t_pose.size(); ++i) {
    if (is_rotation(t_pose[i])) continue;
    return check.refuse(check.called(JointIndex{static_cast<int>(i)}),
                        "its rotation in the T-pose is not a unit quaternion",
                        "correct its numbers");
  }
  return Done{};
}

Status check_limits(const CharacterCheck& check) {
  std::vector<char> seen(check.character.skeleton.joints.size(), 0);
  for (const JointLimit& limit : check.character.limits) {
    if (!check.has(limit.joint)) {
      return check.refuse("limits",
                          "a limit names no joint of the skeleton",
                          "name a joint of the skeleton");
    }
    const std::string called = "limits of " + check.called(limit.joint);
    if (seen[index(limit.joint)]++ != 0) {
      return check.refuse(called, "they are given twice", "remove one");
    }
    if (!is_rotation(limit.t_pose_from_joint)) {
      return check.refuse(
          called, "their axes are not a unit quaternion", "correct its numbers");
    }
    for (const int axis : {0, 1, 2}) {
      const double low = limit.min_rad[axis];
      const double high = limit.max_rad[axis];
      const std::string about = std::string("about ") + "XYZ"[axis] + " ";
      if (!has_finite(low) || !has_finite(high) || std::abs(low) > kPi + kRounded ||
          std::abs(high) > kPi + kRounded) {
        return check.refuse(
            called, about + "they are not within half a turn", "correct the angles");
      }
      if (low > high) {
        return check.refuse(
            called, about + "the minimum is above the maximum", "exchange the two");
      }
    }
  }
  const Flexibility& flexibility = check.character.flexibility;
  if (!is_angle(flexibility.min_trunk_thigh_angle_rad) ||
      !is_angle(flexibility.straight_knee_rad)) {
    return check.refuse("flexibility",
                        "its angles are not between 0 and 180 degrees",
                        "correct the angles");
  }
  return Done{};
}

Status check_mass(const CharacterCheck& check,
                  const std::string& called,
                  const PointMass& mass) {
  if (!check.has(mass.joint)) {
    return check.refuse(
        called, "its joint does not exist", "name a joint of the skeleton");
  }
  if (!has_finite(mass.p_in_joint)) {
    return check.refuse(called, "its place is not finite", "correct its numbers");
  }
  if (!(mass.mass_kg >= 0.0) || !has_finite(mass.mass_kg)) {
    return check.refuse(called, "its mass is negative or not a number", "give it in kg");
  }
  if (!is_near(mass.p_in_joint)) {
    return check.refuse(called,
                        "its place is more than 10 km from its joint",
                        "give its place in metres");
  }
  if (mass.mass_kg > kMaxMass_kg) {
    return check.refuse(called,
                        "its mass is " + digits(mass.mass_kg) + " kg",
                        "give it in kg; " + digits(kMaxMass_kg) + " kg is the maximum");
  }
  return Done{};
}

Status check_masses(const CharacterCheck& check) {
  double total_kg = 0.0;
  for (const PointMass& mass : check.character.masses) {
    std::string called = "mass";
    if (check.has(mass.joint)) called += " of " + check.called(mass.joint);
    if (Status good = check_mass(check, called, mass); !good) return good;
    total_kg += mass.mass_kg;
  }
  if (!(total_kg > 0.0)) {
    return check.refuse("masses", "the total mass is 0", "give its mass in kg");
  }
  const auto& loads = check.character.loads;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i].name.empty()) {
      return check.refuse("load " + std::to_string(i), "it has no name", "name it");
    }
    const std::string called = "load " + in_quotes(loads[i].name);
    for (std::size_t other = 0; other < i; ++other) {
      if (loads[other].name != loads[i].name) continue;
      return check.refuse(called, "there are two of this name", "rename one");
    }
    if (Status good = check_mass(check, called, loads[i].mass); !good) return good;
  }
  return Done{};
}

}  // namespace

Status check_character(const Character& character) {
  CharacterCheck check{character, {}, {}};
  if (Status skeleton = check_skeleton(check); !skeleton) return skeleton;
  check.world_from_joint =
      world_from_joints(character.skeleton, rest_pose(character.skeleton));
  check.group_of.assign(character.skeleton.joints.size(), -1);
  if (Status groups = check_groups(check); !groups) return groups;
  if (Status limits = check_limits(check); !limits) return limits;
  return check_masses(check);
}

Status check_supports(const Character& character) {
  for (const BodyGroup& group : character.groups) {
    if (!group.can_support) continue;
    for (const BodyPart& part : group.parts) {
      if (part.kind == PartKind::kLimb) return Done{};
    }
  }
  return CharacterCheck{character, {}, {}}.refuse(
      "groups",
      "none with a limb can support",
      "let the legs support, or remove the supports");
}

}  // namespace marey::retarget
