// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "calib/plan/planned_body.h"

namespace marey::calib {
namespace {

using B = HumanBone;

/// Both ends in frames of bones, divided by the stature.
struct Part {
  B from;
  glm::dvec3 from_offset;
  B to;
  glm::dvec3 to_offset;
  double radius;
};

/// Trunks are wider than deep: two capsules side by side.
constexpr std::array<Part, 17> kParts{{
    {B::kHips, {0.045, -0.03, 0.0}, B::kChest, {0.035, 0.0, 0.0}, 0.056},
    {B::kHips, {-0.045, -0.03, 0.0}, B::kChest, {-0.035, 0.0, 0.0}, 0.056},
    {B::kChest, {0.035, 0.0, 0.0}, B::kUpperChest, {0.045, 0.05, 0.0}, 0.060},
    {B::kChest, {-0.035, 0.0, 0.0}, B::kUpperChest, {-0.045, 0.05, 0.0}, 0.060},
    {B::kUpperChest, {0.0, 0.06, 0.0}, B::kHead, {0.0, 0.0, 0.0}, 0.035},
    {B::kHead, {0.0, 0.03, 0.005}, B::kHead, {0.0, 0.065, 0.005}, 0.048},
    {B::kUpperChest, {0.0, 0.045, 0.0}, B::kLeftUpperArm, {-0.01, 0.0, 0.0}, 0.036},
    {B::kLeftUpperArm, {0.0, 0.0, 0.0}, B::kLeftLowerArm, {0.0, 0.0, 0.0}, 0.026},
    {B::kLeftLowerArm, {0.0, 0.0, 0.0}, B::kLeftHand, {0.0, 0.0, 0.0}, 0.021},
    {B::kLeftHand, {0.0, 0.0, 0.0}, B::kLeftHand, {0.08, 0.0, 0.0}, 0.015},
    {B::kLeftUpperLeg, {0.0, 0.0, 0.0}, B::kLeftLowerLeg, {0.0, 0.0, 0.0}, 0.042},
    {B::kLeftLowerLeg, {0.0, 0.0, 0.0}, B::kLeftLowerLeg, {0.0, -0.12, 0.0}, 0.033},
    {B::kLeftLowerLeg, {0.0, -0.12, 0.0}, B::kLeftFoot, {0.0, 0.0, 0.0}, 0.024},
    {B::kLeftFoot, {0.0, -0.02, -0.02}, B::kLeftToes, {0.0, 0.0, 0.0}, 0.020},
    {B::kLeftToes, {0.0, 0.0, 0.0}, B::kLeftToes, {0.0, 0.0, 0.04}, 0.016},
    {B::kHips, {0.0, -0.03, 0.0}, B::kLeftUpperLeg, {0.0, 0.0, 0.0}, 0.050},
    {B::kLeftUpperArm, {0.0, 0.0, 0.0}, B::kLeftUpperArm, {0.02, 0.0, 0.0}, 0.032},
}};

bool is_left(B bone) {
  return index(mirrored(bone)) > index(bone);
}

/// Returns the squared distance between two segments: C. Ericson, "Real-Time Collision
/// Detection", 2005, 5.1.9.
double distance2(const glm::dvec3& p1,
                 const glm::dvec3& q1,
                 const glm::dvec3& p2,
                 const glm::dvec3& q2) {
  const glm::dvec3 d1 = q1 - p1;
  const glm::dvec3 d2 = q2 - p2;
  const glm::dvec3 r = p1 - p2;
  const double a = glm::dot(d1, d1);
  const double e = glm::dot(d2, d2);
  const double c = glm::dot(d1, r);
  const double f = glm::dot(d2, r);
  const double b = glm::dot(d1, d2);
  const double across = a * e - b * b;
  double s = across > 1e-12 ? std::clamp((b * f - c * e) / across, 0.0, 1.0) : 0.0;
  double t = e > 1e-12 ? (b * s + f) / e : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  const glm::dvec3 apart = p1 + s * d1 - (p2 + t * d2);
  return glm::dot(apart, apart);
}

}  // namespace

std::vector<SoftTissueCapsule> soft_tissue_of(const PlannedBody& body,
                                              const BodyPlace& place) {
  std::vector<SoftTissueCapsule> soft_tissue;
  const auto add = [&](const Part& part, bool mirror) {
    const auto at = [&](B bone, glm::dvec3 offset) {
      if (mirror) {
        bone = mirrored(bone);
        offset.x = -offset.x;
      }
      return place[index(bone)] * (body.stature_m * offset);
    };
    soft_tissue.push_back({at(part.from, part.from_offset),
                           at(part.to, part.to_offset),
                           part.radius * body.stature_m});
  };
  for (const Part& part : kParts) {
    add(part, false);
    if (is_left(part.from) || is_left(part.to)) add(part, true);
  }
  return soft_tissue;
}

bool is_hidden(const glm::dvec3& p_in_world,
               const glm::dvec3& eye_in_world,
               std::span<const SoftTissueCapsule> soft_tissue) {
  return std::any_of(
      soft_tissue.begin(), soft_tissue.end(), [&](const SoftTissueCapsule& part) {
        return distance2(p_in_world, eye_in_world, part.from_in_world, part.to_in_world) <
               part.radius_m * part.radius_m;
      });
}

}  // namespace marey::calib
