// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vrchat_trackers.h"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "live/vmc/vmc_pose.h"

namespace marey::live {
namespace {

using B = HumanBone;

enum class Part { kAlways, kChest, kKnees, kElbows, kHead };

/// A tracker's number in the protocol and the joints of its position and rotation. The
/// second bone of each pair replaces the first if the body lacks it.
struct Row {
  const char* name;
  Part part;
  std::array<B, 2> place;
  std::array<B, 2> turn;
};

constexpr std::array<Row, 9> kRows{{
    {"1", Part::kAlways, {B::kHips, B::kHips}, {B::kHips, B::kHips}},
    {"2", Part::kChest, {B::kUpperChest, B::kChest}, {B::kUpperChest, B::kChest}},
    {"3", Part::kAlways, {B::kLeftFoot, B::kLeftFoot}, {B::kLeftFoot, B::kLeftFoot}},
    {"4", Part::kAlways, {B::kRightFoot, B::kRightFoot}, {B::kRightFoot, B::kRightFoot}},
    {"5",
     Part::kKnees,
     {B::kLeftLowerLeg, B::kLeftLowerLeg},
     {B::kLeftUpperLeg, B::kLeftUpperLeg}},
    {"6",
     Part::kKnees,
     {B::kRightLowerLeg, B::kRightLowerLeg},
     {B::kRightUpperLeg, B::kRightUpperLeg}},
    {"7",
     Part::kElbows,
     {B::kLeftLowerArm, B::kLeftLowerArm},
     {B::kLeftUpperArm, B::kLeftUpperArm}},
    {"8",
     Part::kElbows,
     {B::kRightLowerArm, B::kRightLowerArm},
     {B::kRightUpperArm, B::kRightUpperArm}},
    {"head", Part::kHead, {B::kHead, B::kHead}, {B::kHead, B::kHead}},
}};

bool wants(const VrchatTrackersOptions& options, Part part) {
  switch (part) {
    case Part::kChest:
      return options.chest;
    case Part::kKnees:
      return options.knees;
    case Part::kElbows:
      return options.elbows;
    case Part::kHead:
      return options.head;
    case Part::kAlways:
      break;
  }
  return true;
}

std::optional<JointIndex> first_of(const Skeleton& skeleton,
                                   const std::array<B, 2>& bones) {
  const auto joint = skeleton.find(bones[0]);
  return joint ? joint : skeleton.find(bones[1]);
}

}  // namespace

VrchatTrackers::VrchatTrackers(const Skeleton& skeleton,
                               const VrchatTrackersOptions& options) {
  const auto& t_pose = options.t_pose_from_joint;
  MAREY_ASSERT(t_pose.empty() || t_pose.size() == skeleton.joints.size());
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  for (const Row& row : kRows) {
    const auto place = first_of(skeleton, row.place);
    const auto turn = first_of(skeleton, row.turn);
    if (!wants(options, row.part) || !place || !turn) continue;
    const std::string address = std::string("/tracking/trackers/") + row.name;
    const std::size_t i = index(*turn);
    trackers_.push_back({address + "/position",
                         address + "/rotation",
                         *place,
                         *turn,
                         glm::conjugate(t_pose.empty() ? rest[i].rotation : t_pose[i])});
  }
}

std::span<const std::uint8_t> VrchatTrackers::encode(
    std::span<const RigidTransform> world_from_joint) {
  writer_.clear();
  const auto write = [this](const std::string& address, const glm::dvec3& v) {
    writer_.begin(address, "fff");
    for (int i = 0; i < 3; ++i) writer_.add(static_cast<float>(v[i]));
  };
  for (const Tracker& tracker : trackers_) {
    const glm::dquat turned =
        world_from_joint[index(tracker.turn)].rotation * tracker.joint_from_t_pose;
    write(tracker.position_address,
          mirrored_x(world_from_joint[index(tracker.place)].translation));
    write(tracker.rotation_address,
          glm::degrees(zxy_angles(mirrored_x(glm::normalize(turned)))));
  }
  const auto packets = writer_.packets();
  return packets.empty() ? std::span<const std::uint8_t>{} : packets[0];
}

glm::dvec3 zxy_angles(const glm::dquat& rotation) {
  // m[column][row] of Ry * Rx * Rz:
  //   row 1: cos x sin z, cos x cos z, -sin x
  //   column 2: sin y cos x, -sin x, cos y cos x
  const glm::dmat3 m = glm::mat3_cast(rotation);
  const double cos_x = std::hypot(m[0][1], m[1][1]);
  const double x = std::atan2(-m[2][1], cos_x);
  // Below this, both products with cos x are rounding errors. With z = 0, column 0 is
  // (cos y, 0, -sin y).
  if (cos_x < 1e-7) return {x, std::atan2(-m[0][2], m[0][0]), 0.0};
  return {x, std::atan2(m[2][0], m[2][2]), std::atan2(m[0][1], m[1][1])};
}

}  // namespace marey::live
