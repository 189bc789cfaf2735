// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/raise_heel.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::retarget {
namespace {

// Greatest angle of the line from pivot to ankle above the horizontal. [rad]
constexpr double kMaxElevation_rad = 1.48;

double elevation_rad(const glm::dvec3& v) {
  return std::atan2(v.y, std::hypot(v.x, v.z));
}

}  // namespace

glm::dvec3 heel_pivot_in_t_pose(const FootMap& foot) {
  if (foot.has_toes) return foot.ball_from_ankle_in_t_pose;
  return foot.ball_from_ankle_in_t_pose + foot.tip_from_ball_in_t_pose;
}

HeelLever heel_lever(const FootMap& foot,
                     const glm::dvec3& ankle_from_pivot,
                     double share) {
  HeelLever out;
  out.ankle_from_pivot = ankle_from_pivot;
  if (share <= 0.0) return out;
  const double now_rad = elevation_rad(ankle_from_pivot);
  const double pitch_rad = now_rad - elevation_rad(-heel_pivot_in_t_pose(foot));
  const double free_rad =
      std::min(kMaxHeelPitch_rad - pitch_rad, kMaxElevation_rad - now_rad);
  const glm::dvec3 axis(-ankle_from_pivot.z, 0.0, ankle_from_pivot.x);
  const double length_m = glm::length(axis);
  if (free_rad <= 0.0 || length_m < 1e-9) return out;
  out.axis = axis / length_m;
  out.max_rad = share * free_rad;
  return out;
}

double heel_rise_rad(const HeelLever& lever,
                     const glm::dvec3& hip_from_pivot,
                     double reach_m) {
  if (lever.max_rad <= 0.0) return 0.0;
  const glm::dvec3& v = lever.ankle_from_pivot;
  const double cosine = glm::dot(hip_from_pivot, v);
  // The square of the distance is wanted at |hip|^2 + |v|^2 - 2 hip.R(a)v, and
  // hip.R(a)v = cosine cos(a) + sine sin(a), because the axis is perpendicular to v.
  const double wanted = 0.5 * (glm::dot(hip_from_pivot, hip_from_pivot) + glm::dot(v, v) -
                               reach_m * reach_m);
  if (cosine >= wanted) return 0.0;
  const double sine = glm::dot(hip_from_pivot, glm::cross(lever.axis, v));
  const double nearest_rad = std::atan2(sine, cosine);
  if (nearest_rad <= 0.0) return 0.0;
  const double amplitude = std::hypot(cosine, sine);
  const double needed_rad =
      nearest_rad - std::acos(std::clamp(wanted / amplitude, -1.0, 1.0));
  return std::clamp(needed_rad, 0.0, lever.max_rad);
}

}  // namespace marey::retarget
