// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/bend_leg.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"
#include "core/transform.h"

namespace marey::retarget {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Sine of the knee's angle from which on the leg's plane alone gives the axis.
constexpr double kPlaneSine = 0.15;
// Sine up to which a knee that is bent the wrong way counts as stretched too far.
constexpr double kOverstretchedSine = 0.3;
constexpr double kShortest_m = 1e-9;

// Turn by `angle_rad` about a unit axis.
glm::dquat turn_about(const glm::dvec3& axis, double angle_rad) {
  const double sine = std::sin(0.5 * angle_rad);
  return {std::cos(0.5 * angle_rad), sine * axis.x, sine * axis.y, sine * axis.z};
}

glm::dvec3 across(const glm::dvec3& along) {
  const glm::dvec3 other =
      std::abs(along.x) < std::abs(along.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(along, other));
}

glm::dvec3 opening_axis(const glm::dvec3& up,
                        const glm::dvec3& down,
                        const glm::dvec3& hinge_in_world) {
  const double scale = glm::length(up) * glm::length(down);
  glm::dvec3 plane = glm::cross(up, down) / scale;
  const double sine = glm::length(plane);
  glm::dvec3 hinge =
      -(hinge_in_world - up * (glm::dot(hinge_in_world, up) / glm::dot(up, up)));
  const double hinge_length = glm::length(hinge);
  hinge = hinge_length > 1e-4 ? hinge / hinge_length : across(up);
  if (sine <= 0.0) return hinge;
  plane /= sine;
  if (sine < kOverstretchedSine && glm::dot(plane, hinge) < 0.0) plane = -plane;
  const double share = smooth_step(sine / kPlaneSine);
  if (share >= 1.0) return plane;
  return glm::normalize((1.0 - share) * hinge + share * plane);
}

}  // namespace

LegBones leg_bones(const glm::dvec3& hip_in_world,
                   const glm::dvec3& knee_in_world,
                   const glm::dvec3& ankle_in_world,
                   const glm::dvec3& hinge_in_world) {
  LegBones out;
  out.up = hip_in_world - knee_in_world;
  out.down = ankle_in_world - knee_in_world;
  out.length_m = glm::length(out.up) + glm::length(out.down);
  out.reach_m = glm::distance(hip_in_world, ankle_in_world);
  out.opening_axis = opening_axis(out.up, out.down, hinge_in_world);
  const glm::dvec3& axis = out.opening_axis;
  out.offset_m2 = glm::dot(out.up, axis) * glm::dot(out.down, axis);
  const double cosine = glm::dot(out.up, out.down) - out.offset_m2;
  const double sine = glm::dot(out.up, glm::cross(axis, out.down));
  out.amplitude_m2 = std::hypot(cosine, sine);
  out.phase_rad = std::atan2(sine, cosine);
  return out;
}

LegTurns bend_leg(const LegBones& bones, const glm::dvec3& ankle_from_hip) {
  const double wanted_m2 =
      0.5 * (glm::dot(bones.up, bones.up) + glm::dot(bones.down, bones.down) -
             glm::dot(ankle_from_hip, ankle_from_hip));
  const double cosine = std::clamp(
      (wanted_m2 - bones.offset_m2) / std::max(bones.amplitude_m2, 1e-18), -1.0, 1.0);
  double angle_rad = bones.phase_rad + std::acos(cosine);
  if (angle_rad > kPi) angle_rad -= 2.0 * kPi;
  LegTurns out;
  out.knee = turn_about(bones.opening_axis, angle_rad);
  const glm::dvec3 end = out.knee * bones.down - bones.up;
  if (glm::length(end) > kShortest_m && glm::length(ankle_from_hip) > kShortest_m) {
    out.thigh = rotation_between(end, ankle_from_hip);
  }
  out.shank = out.thigh * out.knee;
  return out;
}

}  // namespace marey::retarget
