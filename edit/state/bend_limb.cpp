// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/bend_limb.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::edit {
namespace {

/// Sine of the angle between the bones below which they define no plane.
constexpr double kStraightSine = 1e-4;

/// Returns the inner angle between two bones whose far ends are `reach_m` apart, by the
/// half-angle form of the law of cosines, which is accurate for straight limbs too.
double inner_angle_rad(double upper_m, double lower_m, double reach_m) {
  const double square = reach_m * reach_m;
  const double fold = square - (upper_m - lower_m) * (upper_m - lower_m);
  const double stretch = (upper_m + lower_m) * (upper_m + lower_m) - square;
  return 2.0 *
         std::atan2(std::sqrt(std::max(0.0, fold)), std::sqrt(std::max(0.0, stretch)));
}

glm::dvec3 any_perpendicular(const glm::dvec3& along) {
  const glm::dvec3 other =
      std::abs(along.x) < std::abs(along.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(along, other));
}

}  // namespace

LimbBender::LimbBender(const Skeleton& skeleton, const retarget::BodyMap& map)
    : skeleton_(skeleton), map_(map), joints_(skeleton.joints.size()) {}

double LimbBender::move_end(int limb,
                            const glm::dvec3& end_in_world,
                            const std::optional<glm::dquat>& world_from_end,
                            Pose& pose) {
  const auto& body_limb = map_.limbs[static_cast<std::size_t>(limb)];
  MAREY_ASSERT(body_limb.has_value());
  const retarget::LimbMap& bones = *body_limb;
  world_from_joints(skeleton_, pose, joints_);
  const glm::dvec3 root = joints_[index(bones.upper)].translation;
  const glm::dvec3 middle = joints_[index(bones.lower)].translation;
  const glm::dvec3 up = root - middle;
  const glm::dvec3 down = joints_[index(bones.end)].translation - middle;
  const double upper_m = glm::length(up);
  const double lower_m = glm::length(down);
  const double wanted_m = glm::distance(end_in_world, root);
  const double reach_m =
      std::clamp(wanted_m, std::abs(upper_m - lower_m), upper_m + lower_m);

  glm::dvec3 axis = glm::cross(up, down);
  if (glm::length(axis) > kStraightSine * upper_m * lower_m) {
    axis = glm::normalize(axis);
  } else {
    const glm::dvec3 hinge = retarget::rotation_from_t_pose(map_, joints_, bones.upper) *
                             bones.hinge_in_t_pose;
    axis = -(hinge - up * (glm::dot(hinge, up) / (upper_m * upper_m)));
    axis =
        glm::length(axis) > kStraightSine ? glm::normalize(axis) : any_perpendicular(up);
  }
  const double open_rad = inner_angle_rad(upper_m, lower_m, reach_m) -
                          inner_angle_rad(upper_m, lower_m, glm::length(up - down));
  const glm::dquat bend = rotation_from_vector(open_rad * axis);
  const glm::dvec3 bent_end = bend * down - up;
  const bool has_direction = wanted_m > 1e-9 && glm::length(bent_end) > 1e-9;
  const glm::dquat swing = has_direction ? rotation_between(bent_end, end_in_world - root)
                                         : glm::dquat(1, 0, 0, 0);

  const auto parent_rotation = [&](JointIndex joint) {
    const auto parent = skeleton_[joint].parent;
    return parent ? joints_[index(*parent)].rotation : glm::dquat(1, 0, 0, 0);
  };
  const auto turn = [&](JointIndex joint, const glm::dquat& by) {
    glm::dquat& local = pose.parent_from_joint[index(joint)];
    local = glm::normalize(glm::conjugate(parent_rotation(joint)) * by *
                           joints_[index(joint)].rotation);
  };
  turn(bones.upper, swing);
  turn(bones.lower, bend);
  if (world_from_end) {
    pose.parent_from_joint[index(bones.end)] = glm::normalize(
        glm::conjugate(swing * bend * parent_rotation(bones.end)) * *world_from_end);
  }
  return std::abs(wanted_m - reach_m);
}

}  // namespace marey::edit
