// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/human/joint_ranges.h"

#include <algorithm>
#include <array>

#include <glm/common.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"

namespace marey {
namespace {

using B = HumanBone;

constexpr double kMoreThanMeanDeg = 15.0;
constexpr double kFree = 180.0;

struct Range {
  B bone;
  glm::dvec3 min_deg;
  glm::dvec3 max_deg;
  bool exact = false;  ///< True: no margin is added.
};

// Left side and middle. X flexes upright bones forward and hanging bones backward, Y
// rotates to the left, Z raises the left arm.
const std::array<Range, 10>& ranges() {
  static const std::array<Range, 10> list{{
      // Both ends of the neck: half each of flexion 50, extension 60, lateral flexion 45,
      // rotation 80; times two as in the spine.
      {B::kNeck, {-60, -80, -45}, {50, 80, 45}},
      {B::kHead, {-60, -80, -45}, {50, 80, 45}},
      // Axial rotation; retraction and protraction; elevation and depression.
      {B::kLeftShoulder, {-35, -30, -10}, {10, 30, 45}},
      // External and internal rotation, 90 and 70 in the T-pose and 20 more elsewhere
      // (their zero rotates with the arm); horizontal adduction and abduction; adduction
      // to 45 past the side, and raised straight up.
      {B::kLeftUpperArm, {-110, -135, -135}, {90, 45, 90}},
      // Supination and pronation; flexion; the carrying angle, free.
      {B::kLeftLowerArm, {-105, -150, -kFree}, {105, 5, kFree}, true},
      // The rotation of the forearm again, for skeletons that have it here; radial and
      // ulnar deviation, 20 and 30, and 20 more for the combination of flexion with that
      // rotation; flexion and extension.
      {B::kLeftHand, {-80, -40, -80}, {80, 50, 70}},
      // Flexion and extension; internal and external rotation; adduction, abduction.
      {B::kLeftUpperLeg, {-120, -45, -30}, {30, 45, 45}},
      // Flexion; rotation of the shank; lateral, which is the rotation of the flexed
      // knee.
      {B::kLeftLowerLeg, {-5, -60, -60}, {150, 60, 60}, true},
      // Dorsal and plantar flexion, dorsal to 35 under body weight (20 without);
      // adduction and abduction; inversion, eversion.
      {B::kLeftFoot, {-35, -20, -35}, {50, 20, 15}},
      {B::kLeftToes, {-70, -5, -5}, {45, 5, 5}},
  }};
  return list;
}

glm::dvec3 more(const glm::dvec3& deg, double by_deg) {
  return glm::clamp(deg + by_deg, -kFree, kFree) * kRadiansPerDegree;
}

// Reflection in X = 0 keeps rotations about X and reverses the others.
BoneLimit reflected(const BoneLimit& left) {
  BoneLimit right{mirrored(left.bone), left.min_rad, left.max_rad};
  for (const int axis : {1, 2}) {
    right.min_rad[axis] = -left.max_rad[axis];
    right.max_rad[axis] = -left.min_rad[axis];
  }
  return right;
}

}  // namespace

std::optional<BoneLimit> joint_range(HumanBone bone) {
  for (const Range& range : ranges()) {
    const double by_deg = range.exact ? 0.0 : kMoreThanMeanDeg;
    const BoneLimit limit{
        range.bone, more(range.min_deg, -by_deg), more(range.max_deg, by_deg)};
    if (range.bone == bone) return limit;
    if (mirrored(range.bone) == bone) return reflected(limit);
  }
  return std::nullopt;
}

BoneLimit spine_range(int count) {
  MAREY_ASSERT(count > 0);
  // Thoracic and lumbar: extension 25, flexion 80; rotation 45; lateral flexion 35.
  const double by_deg = kMoreThanMeanDeg;
  const double share = std::min(1.0, 2.0 / count);
  return {B::kSpine,
          share * more({-25, -45, -35}, -by_deg),
          share * more({80, 45, 35}, by_deg)};
}

}  // namespace marey
