// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/segment_directions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::testing {
namespace {

using B = HumanBone;

/// First and last joint of each segment. directions_of() does not use the trunk's.
constexpr std::array<std::pair<B, B>, kSegmentCount> kEnds{{
    {B::kHips, B::kNeck},
    {B::kNeck, B::kHead},
    {B::kLeftUpperArm, B::kLeftLowerArm},
    {B::kLeftLowerArm, B::kLeftHand},
    {B::kRightUpperArm, B::kRightLowerArm},
    {B::kRightLowerArm, B::kRightHand},
    {B::kLeftUpperLeg, B::kLeftLowerLeg},
    {B::kLeftLowerLeg, B::kLeftFoot},
    {B::kRightUpperLeg, B::kRightLowerLeg},
    {B::kRightLowerLeg, B::kRightFoot},
    {B::kLeftFoot, B::kLeftToes},
    {B::kRightFoot, B::kRightToes},
}};

/// Places of bones in one posture.
struct Posed {
  const BoneJoints& joints;
  std::vector<RigidTransform> world;

  [[nodiscard]] std::optional<glm::dvec3> place(B bone) const {
    const auto joint = joints[index(bone)];
    return joint ? std::optional(world[index(*joint)].translation) : std::nullopt;
  }
  [[nodiscard]] std::optional<glm::dvec3> between(B a, B b) const {
    const auto from = place(a);
    const auto to = place(b);
    return from && to ? std::optional(0.5 * (*from + *to)) : std::nullopt;
  }
};

std::optional<glm::dvec3> direction(const std::optional<glm::dvec3>& from,
                                    const std::optional<glm::dvec3>& to) {
  if (!from || !to || glm::distance(*from, *to) < 1e-9) return std::nullopt;
  return glm::normalize(*to - *from);
}

/// Over the floor: how high an ankle lies above the toes is the body's own. nullopt where
/// a foot is steeper than 60 degrees.
std::optional<glm::dvec3> level(const std::optional<glm::dvec3>& foot) {
  if (!foot || std::hypot(foot->x, foot->z) < 0.5) return std::nullopt;
  return glm::normalize(glm::dvec3(foot->x, 0.0, foot->z));
}

Directions directions_of(const Posed& posed) {
  Directions out;
  const auto hips = posed.between(B::kLeftUpperLeg, B::kRightUpperLeg);
  const auto neck = posed.place(B::kNeck);
  out[0] =
      direction(hips, neck ? neck : posed.between(B::kLeftUpperArm, B::kRightUpperArm));
  for (std::size_t i = 1; i < kSegmentCount; ++i) {
    out[i] = direction(posed.place(kEnds[i].first), posed.place(kEnds[i].second));
    if (i >= static_cast<std::size_t>(Segment::kLeftFoot)) out[i] = level(out[i]);
  }
  return out;
}

}  // namespace

std::string_view name(Segment segment) {
  constexpr std::array<std::string_view, kSegmentCount> kNames{"trunk",
                                                               "neck",
                                                               "left upper arm",
                                                               "left forearm",
                                                               "right upper arm",
                                                               "right forearm",
                                                               "left thigh",
                                                               "left shank",
                                                               "right thigh",
                                                               "right shank",
                                                               "left foot",
                                                               "right foot"};
  return kNames[static_cast<std::size_t>(segment)];
}

BoneJoints marked_joints(const Skeleton& skeleton) {
  BoneJoints joints;
  for (const B bone : human_bones()) joints[index(bone)] = skeleton.find(bone);
  return joints;
}

BoneJoints named_joints(
    const Skeleton& skeleton,
    const SideWords& sides,
    std::initializer_list<std::pair<HumanBone, std::string_view>> names) {
  BoneJoints joints;
  for (const auto& [bone, pattern] : names) {
    const std::size_t at = pattern.find("{}");
    const auto with = [&](std::string_view word) {
      std::string name(pattern);
      if (at != std::string_view::npos) name.replace(at, 2, word);
      return skeleton.find(std::string_view(name));
    };
    joints[index(bone)] = with(sides.left);
    if (at != std::string_view::npos) joints[index(mirrored(bone))] = with(sides.right);
  }
  return joints;
}

Directions directions_of(const Skeleton& skeleton,
                         const BoneJoints& joints,
                         const Pose& pose) {
  return directions_of(Posed{joints, world_from_joints(skeleton, pose)});
}

std::pair<double, Segment> DirectionErrors::worst_mean() const {
  std::pair<double, Segment> worst{0.0, Segment::kTrunk};
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    if (mean_rad[i] && *mean_rad[i] > worst.first) {
      worst = {*mean_rad[i], static_cast<Segment>(i)};
    }
  }
  return worst;
}

DirectionErrors compare_directions(const Motion& source,
                                   const BoneJoints& source_joints,
                                   const Motion& result,
                                   const BoneJoints& result_joints) {
  std::array<std::vector<double>, kSegmentCount> angles;
  const std::size_t frames = std::min(source.poses.size(), result.poses.size());
  for (std::size_t t = 0; t < frames; ++t) {
    const Directions a = directions_of(source.skeleton, source_joints, source.poses[t]);
    const Directions b = directions_of(result.skeleton, result_joints, result.poses[t]);
    for (std::size_t i = 0; i < kSegmentCount; ++i) {
      if (!a[i] || !b[i]) continue;
      angles[i].push_back(
          std::atan2(glm::length(glm::cross(*a[i], *b[i])), glm::dot(*a[i], *b[i])));
    }
  }
  DirectionErrors errors;
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    auto& list = angles[i];
    if (list.empty()) continue;
    double sum = 0.0;
    for (const double angle : list) sum += angle;
    std::ranges::sort(list);
    errors.mean_rad[i] = sum / static_cast<double>(list.size());
    errors.p95_rad[i] = list[(list.size() - 1) * 95 / 100];
    errors.worst_rad[i] = list.back();
  }
  return errors;
}

glm::dvec3 facing_of(const Skeleton& skeleton,
                     const BoneJoints& joints,
                     const Pose& pose) {
  const Posed posed{joints, world_from_joints(skeleton, pose)};
  const auto left = posed.place(B::kLeftUpperLeg);
  const auto right = posed.place(B::kRightUpperLeg);
  if (!left || !right) return {0, 0, 1};
  const glm::dvec3 across = *left - *right;
  const glm::dvec3 front(-across.z, 0.0, across.x);
  return glm::normalize(front);
}

}  // namespace marey::testing
