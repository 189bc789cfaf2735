// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/match_carriage.h"

#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/humanoid.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kNoCarriage_rad = 1.0471975511965976;  // 60 degrees.
constexpr double kNoLength_m = 1e-6;
// The trunk's line turns by less than its vertebrae, which begin above the hips.
constexpr int kTrunkSteps = 6;

/// World positions of joints at rest, equal to those of the T-pose except in the limbs.
/// [m]
struct RestPlaces {
  const BodyMap& map;
  std::vector<RigidTransform> world_from_joint;

  RestPlaces(const Skeleton& body, const BodyMap& body_map)
      : map(body_map), world_from_joint(world_from_joints(body, rest_pose(body))) {}

  [[nodiscard]] std::optional<glm::dvec3> of(B bone) const {
    const auto joint = map.joint_of[index(bone)];
    if (!joint) return std::nullopt;
    return world_from_joint[index(*joint)].translation;
  }
  [[nodiscard]] std::optional<glm::dvec3> middle(B left) const {
    const auto a = of(left);
    const auto b = of(mirrored(left));
    if (!a || !b) return std::nullopt;
    return 0.5 * (*a + *b);
  }
  /// Vector from mid-hip to the first vertebra (`below`), and on to mid-shoulder
  /// (`above`). The vertebrae turn the latter alone.
  struct Trunk {
    glm::dvec3 below;
    glm::dvec3 above;
  };
  [[nodiscard]] std::optional<Trunk> trunk() const {
    const auto hips = middle(B::kLeftUpperLeg);
    const auto shoulders = middle(B::kLeftUpperArm);
    const SpineSection& first = map.abdomen.count > 0 ? map.abdomen : map.torso;
    if (!hips || !shoulders) return std::nullopt;
    const glm::dvec3 begin =
        first.count > 0 ? world_from_joint[index(first.joints[0])].translation : *hips;
    if (glm::distance(*shoulders, *hips) < kNoLength_m) return std::nullopt;
    return Trunk{begin - *hips, *shoulders - begin};
  }
  [[nodiscard]] std::optional<glm::dvec3> neck() const {
    const auto neck = of(B::kNeck);
    const auto head = of(B::kHead);
    if (!neck || !head || glm::distance(*neck, *head) < kNoLength_m) return std::nullopt;
    return *head - *neck;
  }
};

/// Returns the rotation of `from` towards `to` that leaves them kKeptCarriage_rad apart.
glm::dquat turn_nearer(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double sine = glm::length(axis);
  const double apart_rad = std::atan2(sine, glm::dot(from, to));
  if (apart_rad <= kKeptCarriage_rad || apart_rad > kNoCarriage_rad) {
    return {1.0, 0.0, 0.0, 0.0};
  }
  return glm::angleAxis(apart_rad - kKeptCarriage_rad, axis / sine);
}

void turn(const glm::dquat& by, JointIndex joint, BodyMap& map) {
  glm::dquat& t_pose = map.joints[index(joint)].t_pose_from_joint;
  t_pose = glm::normalize(by * t_pose);
}

void turn(const glm::dquat& by, SpineSection& section, BodyMap& map) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(section.count); ++i) {
    turn(by, section.joints[i], map);
    section.bone_in_t_pose[i] = by * section.bone_in_t_pose[i];
  }
}

void match_trunk(const RestPlaces& from, const RestPlaces& to, BodyMap& avatar) {
  const auto wanted = from.trunk();
  const auto own = to.trunk();
  if (!wanted || !own || !avatar.spine) return;
  const glm::dvec3 line = glm::normalize(wanted->below + wanted->above);
  glm::dquat by(1.0, 0.0, 0.0, 0.0);
  for (int step = 0; step < kTrunkSteps; ++step) {
    by = glm::normalize(turn_nearer(glm::normalize(own->below + by * own->above), line) *
                        by);
  }
  if (by == glm::dquat(1.0, 0.0, 0.0, 0.0)) return;
  turn(by, avatar.abdomen, avatar);
  turn(by, avatar.torso, avatar);
  avatar.spine->girdle_in_t_pose = by * avatar.spine->girdle_in_t_pose;
  for (const B collar : {B::kLeftShoulder, B::kRightShoulder}) {
    if (const auto joint = avatar.joint_of[index(collar)]) turn(by, *joint, avatar);
  }
}

void match_neck(const RestPlaces& from, const RestPlaces& to, BodyMap& avatar) {
  const auto wanted = from.neck();
  const auto own = to.neck();
  if (!wanted || !own || avatar.neck.count == 0) return;
  const glm::dquat by = turn_nearer(glm::normalize(*own), glm::normalize(*wanted));
  if (by != glm::dquat(1.0, 0.0, 0.0, 0.0)) turn(by, avatar.neck, avatar);
}

}  // namespace

void match_carriage(const Skeleton& source_body,
                    const BodyMap& source,
                    const Skeleton& body,
                    BodyMap& avatar) {
  const RestPlaces from(source_body, source);
  const RestPlaces to(body, avatar);
  match_trunk(from, to, avatar);
  match_neck(from, to, avatar);
}

}  // namespace marey::retarget
