// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/exchanged_sides.h"

#include <array>
#include <initializer_list>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "retarget/bones/body_places.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

/// A weighted mean of cosines.
struct WeightedMean {
  double sum = 0.0;
  double weight = 0.0;

  void add(const glm::dvec3& v, const glm::dvec3& front) {
    sum += glm::dot(v, front);
    weight += glm::length(v);
  }
  [[nodiscard]] std::optional<double> value(double min_weight) const {
    if (weight <= min_weight) return std::nullopt;
    return sum / weight;
  }
};

class SideMeter {
 public:
  SideMeter(const Motion& motion, const FoundBones& found)
      : motion_(motion), found_(found), world_(motion.skeleton.joints.size()) {}

  SideEvidence measure() {
    for (const Pose& pose : motion_.poses) add(pose);
    // Share of a leg's length: a frame's bend is weighted by the joint's distance from
    // its line.
    const double frames = static_cast<double>(motion_.poses.size());
    constexpr double kMinBend = 0.01;
    constexpr double kMinWay = 0.5;
    SideEvidence out;
    out.knees = knees_.value(kMinBend * frames);
    out.toes = toes_.value(0.1 * frames);
    out.walk = walk_.value(kMinWay);
    out.elbows = elbows_.value(kMinBend * frames);
    out.arms_as_legs = arms_as_legs_.value(0.0);
    return out;
  }

 private:
  [[nodiscard]] std::optional<glm::dvec3> place(B bone) const {
    const auto joint = found_.joint(bone);
    if (!joint) return std::nullopt;
    return world_[index(*joint)].translation;
  }
  /// Vector from the line between two joints to the joint that bends between them.
  static glm::dvec3 bend(const glm::dvec3& from,
                         const glm::dvec3& joint,
                         const glm::dvec3& to) {
    const glm::dvec3 along = unit_of(to - from);
    return joint - from - along * glm::dot(joint - from, along);
  }

  void add(const Pose& pose) {
    world_from_joints(motion_.skeleton, pose, world_);
    const BodyPlaces p = body_places(
        found_, [&](JointIndex joint) { return world_[index(joint)].translation; });
    const glm::dvec3 across = unit_of(p.hip[0] - p.hip[1]);
    const glm::dvec3 up = unit_of(p.head.value_or(p.hips) - p.mid_hip());
    const glm::dvec3 front = unit_of(glm::cross(across, up));
    if (front == glm::dvec3(0.0)) return;
    add_legs(front);
    add_arms(front, across);
    if (before_) {
      const glm::dvec3 way = p.mid_hip() - *before_;
      walk_.add((way - up * glm::dot(way, up)) / leg_length_, front);
    }
    before_ = p.mid_hip();
  }
  void add_legs(const glm::dvec3& front) {
    for (const auto& [thigh, shank, foot, toes] :
         {std::array{B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot, B::kLeftToes},
          std::array{
              B::kRightUpperLeg, B::kRightLowerLeg, B::kRightFoot, B::kRightToes}}) {
      const auto hip = place(thigh);
      const auto knee = place(shank);
      const auto ankle = place(foot);
      if (!hip || !knee || !ankle) continue;
      leg_length_ = glm::distance(*hip, *knee) + glm::distance(*knee, *ankle);
      if (leg_length_ <= 0.0) continue;
      knees_.add(bend(*hip, *knee, *ankle) / leg_length_, front);
      if (const auto toe = place(toes)) toes_.add(unit_of(*toe - *ankle), front);
    }
  }
  void add_arms(const glm::dvec3& front, const glm::dvec3& across) {
    const auto left = place(B::kLeftUpperArm);
    const auto right = place(B::kRightUpperArm);
    if (!left || !right) return;
    arms_as_legs_.add(unit_of(*left - *right), across);
    for (const auto& [upper, lower, hand] :
         {std::array{B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand},
          std::array{B::kRightUpperArm, B::kRightLowerArm, B::kRightHand}}) {
      const auto shoulder = place(upper);
      const auto elbow = place(lower);
      const auto wrist = place(hand);
      if (!shoulder || !elbow || !wrist) continue;
      elbows_.add(bend(*shoulder, *elbow, *wrist) / leg_length_, -front);
    }
  }

  const Motion& motion_;
  const FoundBones& found_;
  std::vector<RigidTransform> world_;
  double leg_length_ = 1.0;
  std::optional<glm::dvec3> before_;
  WeightedMean knees_;
  WeightedMean toes_;
  WeightedMean walk_;
  WeightedMean elbows_;
  WeightedMean arms_as_legs_;
};

}  // namespace

SideEvidence side_evidence(const Motion& motion, const FoundBones& found) {
  return SideMeter(motion, found).measure();
}

ExchangedSides exchanged_sides(const SideEvidence& evidence) {
  constexpr double kClear = 0.5;
  int backwards = 0;
  int forwards = 0;
  for (const auto& one : {evidence.knees, evidence.toes, evidence.walk}) {
    if (one && *one < -kClear) ++backwards;
    if (one && *one > kClear) ++forwards;
  }
  const bool arms_differ = evidence.arms_as_legs && *evidence.arms_as_legs < -kClear;
  const bool arms_backwards = evidence.elbows && *evidence.elbows < -kClear;
  const bool legs_backwards =
      forwards == 0 &&
      (backwards > 1 || (backwards == 1 && (arms_backwards || arms_differ)));
  if (arms_differ) return legs_backwards ? ExchangedSides::kLegs : ExchangedSides::kArms;
  return legs_backwards ? ExchangedSides::kBody : ExchangedSides::kNone;
}

}  // namespace marey::retarget
