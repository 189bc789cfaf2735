// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/skeleton.h"

namespace marey {

/// Kinematic kind of a body part (Kulpa 2005, 1.1.2).
enum class PartKind {
  kLimb,     ///< Upper bone, lower bone, extremity: solved as one, analytically.
  kSection,  ///< A run of vertebrae, low to high, that bends as a whole.
  kSegment,  ///< One rigid bone: clavicle, neck, head, hand, foot.
};

/// One part of a group. Joints are given by their index in the skeleton: a kLimb has
/// exactly three (shoulder, elbow, wrist), a kSection one or more, a kSegment one.
struct BodyPart {
  PartKind kind = PartKind::kSegment;
  std::vector<JointIndex> joints;
  /// For a kLimb: unit axis in the upper joint's frame, about which a positive turn of
  /// the lower joint bends the limb the natural way. Used when the limb is straight.
  glm::dvec3 hinge_in_upper{0.0};
};

/// Parts that adaptation moves together, and their order (Kulpa 2005, 4.1, figures 4.3
/// and 4.4). Groups are data: another creature is another table.
struct BodyGroup {
  std::string name;  ///< "left arm"
  /// 1 is the root, 2 is below it, 3 below a group of level 2.
  int level = 2;
  std::optional<int> parent;  ///< Position of the group that carries this one.
  bool can_support = false;   ///< Its limb may stand on the floor.
  /// Adapts the centre of mass if true. The head's is false: it is too light to help and
  /// bends absurdly (Kulpa 2005, 5.5).
  bool balances = true;
  std::vector<BodyPart> parts;  ///< In the order in which kinematics adapts them.
};

/// Limits of a joint's rotation from the T-pose (Character::t_pose_from_joint; an avatar
/// may rest otherwise): each axis of the joint's rotation in its parent, in the T-pose's
/// axes, limited separately. [rad]
struct JointLimit {
  JointIndex joint{};
  /// T-pose axes from the joint's frame in the T-pose: make_character() takes them from
  /// Character::t_pose_from_joint; a custom table may use other axes for a joint.
  glm::dquat t_pose_from_joint{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 min_rad{-3.14159265358979323846};
  glm::dvec3 max_rad{3.14159265358979323846};
};

/// A mass that moves with a joint: a body segment or a carried object.
struct PointMass {
  JointIndex joint{};
  glm::dvec3 p_in_joint{0.0};  ///< Centre of mass, in the joint's frame. [m]
  double mass_kg = 0.0;
  /// Inertia about its own centre of mass per kilogram, in the axes of the joint's frame:
  /// symmetric; its eigenvalues are the squared radii of gyration. [m^2] 0: a point.
  glm::dmat3 inertia_per_kg_m2{0.0};
};

/// A mass carried for a while: a bag in a hand. It has a name, so that it can be added
/// and removed.
struct Load {
  std::string name;
  PointMass mass;
};

/// Muscles that span two joints (Kulpa 2005, 4.2.3) limit the angle between trunk and
/// thigh while the leg is straight.
struct Flexibility {
  double min_trunk_thigh_angle_rad = 0.0;  ///< 0: no limit. Upright is pi.
  double straight_knee_rad = 0.17;  ///< A knee bent less than this is a straight leg.
};

/// A body for adaptation: structure (skeleton), groups, and individual properties (Kulpa
/// 2005, 4.1).
struct Character {
  std::string name;
  Skeleton skeleton;
  /// Rotation of each joint's frame in the canonical T-pose, in world axes; defines the
  /// axes of BodyPoint::offset_in_t_pose. One per joint; empty: the rest pose is the
  /// T-pose.
  std::vector<glm::dquat> t_pose_from_joint;
  /// In the order of kinematic adaptation, light to heavy; the root's group is last.
  std::vector<BodyGroup> groups;
  /// Joints without a limit turn freely. The root turns freely too; its limit has no
  /// effect, since a body may have any orientation.
  std::vector<JointLimit> limits;
  Flexibility flexibility;
  std::vector<PointMass> masses;  ///< One or more per joint that has mass.
  std::vector<Load> loads;        ///< In addition to `masses`.
};

}  // namespace marey
