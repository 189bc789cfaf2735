// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_soft_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::testing {
namespace {

using B = HumanBone;

bool is_ellipsoid(const SoftTissuePart& part) {
  return part.a == part.b;
}

/// Squared distance between two line segments: C. Ericson, "Real-Time Collision
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

double distance2_to_origin(const glm::dvec3& p, const glm::dvec3& q) {
  const glm::dvec3 d = q - p;
  const double s = std::clamp(-glm::dot(p, d) / glm::dot(d, d), 0.0, 1.0);
  const glm::dvec3 nearest = p + s * d;
  return glm::dot(nearest, nearest);
}

/// Returns the depth of a point in a part: below 1 is inside.
double depth(const SoftTissuePart& part, const glm::dvec3& p) {
  if (is_ellipsoid(part)) return glm::length((p - part.a) / part.radii);
  const glm::dvec3 along = part.b - part.a;
  const double s =
      std::clamp(glm::dot(p - part.a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - part.a - s * along) / part.radii.x;
}

class SoftTissueMaker {
 public:
  explicit SoftTissueMaker(const SimulatedBody& body) : body_(body) {}

  void ellipsoid(B bone, const glm::dvec3& centre, const glm::dvec3& radii) {
    const double h = body_.stature_m;
    const glm::dvec3 thick(body_.build, 1.0, body_.build);
    parts_.push_back({bone, h * centre, h * centre, h * radii * thick});
  }
  /// From `from` to `to` of the way to the bone's end, on both sides of the body.
  void limb(B left, double from, double to, double radius) {
    for (const B bone : {left, mirrored(left)}) {
      const glm::dvec3 end = end_of(bone, body_.proportions);
      const double radius_m = radius * body_.build * body_.stature_m;
      parts_.push_back({bone, from * end, to * end, glm::dvec3(radius_m)});
    }
  }
  [[nodiscard]] std::vector<SoftTissuePart> parts() const { return parts_; }

 private:
  const SimulatedBody& body_;
  std::vector<SoftTissuePart> parts_;
};

}  // namespace

std::vector<SoftTissuePart> soft_tissue_of(const SimulatedBody& body) {
  SoftTissueMaker make(body);
  make.ellipsoid(B::kHips, {0, -0.005, -0.005}, {0.096, 0.085, 0.068});
  make.ellipsoid(B::kSpine, {0, 0.035, 0.0}, {0.080, 0.075, 0.060});
  make.ellipsoid(B::kChest, {0, 0.040, 0.0}, {0.086, 0.095, 0.066});
  make.ellipsoid(B::kUpperChest, {0, 0.015, 0.0}, {0.095, 0.085, 0.068});
  make.ellipsoid(B::kHead, {0, 0.055, 0.010}, {0.044, 0.066, 0.056});
  // A neck; its mirror is itself.
  make.limb(B::kNeck, -0.4, 1.0, 0.033);
  make.limb(B::kLeftShoulder, 0.3, 1.0, 0.030);
  make.limb(B::kLeftUpperArm, 0.0, 0.5, 0.031);
  make.limb(B::kLeftUpperArm, 0.5, 1.0, 0.026);
  make.limb(B::kLeftLowerArm, 0.0, 0.5, 0.024);
  make.limb(B::kLeftLowerArm, 0.5, 1.0, 0.018);
  make.limb(B::kLeftHand, 0.1, 0.75, 0.014);
  make.limb(B::kLeftUpperLeg, 0.0, 0.5, 0.046);
  make.limb(B::kLeftUpperLeg, 0.5, 1.0, 0.035);
  make.limb(B::kLeftLowerLeg, 0.0, 0.5, 0.032);
  make.limb(B::kLeftLowerLeg, 0.5, 1.0, 0.023);
  make.limb(B::kLeftFoot, 0.0, 1.1, 0.021);
  return make.parts();
}

SkinPoint skin_point(std::span<const SoftTissuePart> soft_tissue,
                     HumanBone bone,
                     const glm::dvec3& from_in_bone,
                     const glm::dvec3& direction) {
  // By steps: shapes are many, and this is done once for each tag.
  constexpr double kStep_m = 0.0005;
  constexpr double kMaxDistance_m = 0.35;
  const glm::dvec3 d = glm::normalize(direction);
  SkinPoint found{from_in_bone, d};
  for (double s = 0.0; s < kMaxDistance_m; s += kStep_m) {
    const glm::dvec3 p = from_in_bone + s * d;
    for (const SoftTissuePart& part : soft_tissue) {
      if (part.bone != bone || depth(part, p) > 1.0) continue;
      found.p_in_bone = p;
      if (is_ellipsoid(part)) {
        found.out = glm::normalize((p - part.a) / (part.radii * part.radii));
      } else {
        const glm::dvec3 along = glm::normalize(part.b - part.a);
        found.out = glm::normalize(d - 0.98 * glm::dot(d, along) * along);
      }
    }
  }
  return found;
}

bool is_hidden(std::span<const SoftTissuePart> soft_tissue,
               const BoneFrames& world_from_bone,
               const glm::dvec3& p_in_world,
               const glm::dvec3& eye_in_world,
               HumanBone own,
               double thinner_m) {
  for (const SoftTissuePart& part : soft_tissue) {
    const double less_m = part.bone == own ? thinner_m : 0.0;
    const RigidTransform& frame = world_from_bone[index(part.bone)];
    if (is_ellipsoid(part)) {
      const RigidTransform bone_from_world = inverse(frame);
      const glm::dvec3 radii = part.radii - less_m;
      const glm::dvec3 p = (bone_from_world * p_in_world - part.a) / radii;
      const glm::dvec3 eye = (bone_from_world * eye_in_world - part.a) / radii;
      if (distance2_to_origin(p, eye) < 1.0) return true;
      continue;
    }
    const double radius_m = part.radii.x - less_m;
    if (distance2(p_in_world, eye_in_world, frame * part.a, frame * part.b) <
        radius_m * radius_m) {
      return true;
    }
  }
  return false;
}

}  // namespace marey::testing
