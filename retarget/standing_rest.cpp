// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/standing_rest.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/assert.h"
#include "core/humanoid.h"
#include "core/pose.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using Joints = std::array<std::optional<JointIndex>, kHumanBoneCount>;

constexpr glm::dvec3 kUp(0, 1, 0);
constexpr std::array<B, 2> kUpperLegs{B::kLeftUpperLeg, B::kRightUpperLeg};
constexpr std::array<B, 2> kFeet{B::kLeftFoot, B::kRightFoot};
constexpr std::array<B, 2> kToes{B::kLeftToes, B::kRightToes};
constexpr std::array<B, 2> kUpperArms{B::kLeftUpperArm, B::kRightUpperArm};

Joints joints_of(const Skeleton& skeleton) {
  Joints out;
  for (const B bone : human_bones()) out[index(bone)] = skeleton.find(bone);
  return out;
}

/// One posture, looked at in its own heading.
class View {
 public:
  View(const Joints& joints, std::span<const RigidTransform> world_from_joint)
      : joints_(joints), world_from_joint_(world_from_joint) {
    glm::dvec3 left = place(B::kLeftUpperLeg) - place(B::kRightUpperLeg);
    left.y = 0.0;
    // Hips that lie on their side have no heading; such frames are chosen for nothing.
    if (glm::length(left) > 1e-9) forward_ = rotation_between(left, {1, 0, 0});
  }

  [[nodiscard]] glm::dvec3 place(B bone) const {
    return world_from_joint_[index(*joints_[index(bone)])].translation;
  }
  /// Unit; zero if one is missing or both are in one place.
  [[nodiscard]] glm::dvec3 direction(B from, B to) const {
    if (!joints_[index(from)] || !joints_[index(to)]) return glm::dvec3(0.0);
    const glm::dvec3 span = place(to) - place(from);
    const double length = glm::length(span);
    return length > 1e-9 ? forward_ * (span / length) : glm::dvec3(0.0);
  }
  /// From what world axes are to the axes of a body that faces +Z.
  [[nodiscard]] const glm::dquat& forward() const { return forward_; }

 private:
  const Joints& joints_;
  std::span<const RigidTransform> world_from_joint_;
  glm::dquat forward_{1.0, 0.0, 0.0, 0.0};
};

B top_of_trunk(const Joints& joints) {
  for (const B bone : {B::kNeck, B::kHead, B::kUpperChest, B::kChest, B::kSpine}) {
    if (joints[index(bone)]) return bone;
  }
  return B::kHips;
}

B lower_of(B upper) {
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.upper == upper) return limb.lower;
  }
  return upper;
}

B end_of(B upper) {
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.upper == upper) return limb.end;
  }
  return upper;
}

/// Parts of the body that are looked for apart.
enum Part : std::size_t {
  kTrunk,
  kLeftArm,
  kRightArm,
  kLeftLeg,
  kRightLeg,
  kLeftFootPart,
  kRightFootPart,
  kPartCount
};

/// How well a posture shows how each part is built; more is better.
std::array<double, kPartCount> merits(const Joints& joints,
                                      const View& view,
                                      double leg_m) {
  std::array<double, kPartCount> out{};
  out[kTrunk] = view.direction(B::kHips, top_of_trunk(joints)).y +
                view.direction(B::kRightUpperLeg, B::kLeftUpperLeg).x +
                view.direction(B::kRightUpperArm, B::kLeftUpperArm).x;
  for (std::size_t side = 0; side < 2; ++side) {
    const double out_sign = side == 0 ? 1.0 : -1.0;
    const B arm = kUpperArms[side];
    const glm::dvec3 upper_arm = view.direction(arm, lower_of(arm));
    const glm::dvec3 lower_arm = view.direction(lower_of(arm), end_of(arm));
    out[kLeftArm + side] =
        glm::dot(upper_arm, lower_arm) +
        std::max(-0.5 * (upper_arm.y + lower_arm.y),
                 0.5 * out_sign * (upper_arm.x + lower_arm.x));
    const B leg = kUpperLegs[side];
    out[kLeftLeg + side] = -view.direction(leg, lower_of(leg)).y -
                           view.direction(lower_of(leg), end_of(leg)).y;
    double height_m = view.place(kFeet[side]).y;
    if (joints[index(kToes[side])]) height_m += view.place(kToes[side]).y;
    out[kLeftFootPart + side] = -height_m / leg_m;
  }
  return out;
}

/// Which part each joint is of: that of its nearest ancestor that begins one.
std::vector<Part> parts_of(const Skeleton& skeleton, const Joints& joints) {
  std::vector<Part> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    Part part = joint.parent ? out[index(*joint.parent)] : kTrunk;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto begins = [&](B bone) {
        return joints[index(bone)] && index(*joints[index(bone)]) == j;
      };
      if (begins(kUpperArms[side])) part = static_cast<Part>(kLeftArm + side);
      if (begins(kUpperLegs[side])) part = static_cast<Part>(kLeftLeg + side);
      if (begins(kFeet[side])) part = static_cast<Part>(kLeftFootPart + side);
    }
    out.push_back(part);
  }
  return out;
}

/// The best look at each part over a motion.
struct BestLooks {
  std::array<double, kPartCount> merit;
  std::array<std::size_t, kPartCount> frame{};
};

BestLooks find_looks(const Motion& motion, const Joints& joints) {
  BestLooks best;
  best.merit.fill(-1e9);
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    world_from_joints(motion.skeleton, motion.poses[t], world_from_joint);
    const View view(joints, world_from_joint);
    const double leg_m =
        glm::length(view.place(B::kLeftUpperLeg) - view.place(B::kLeftLowerLeg)) +
        glm::length(view.place(B::kLeftLowerLeg) - view.place(B::kLeftFoot));
    const auto merit = merits(joints, view, leg_m);
    for (std::size_t part = 0; part < kPartCount; ++part) {
      if (merit[part] <= best.merit[part]) continue;
      best.merit[part] = merit[part];
      best.frame[part] = t;
    }
  }
  return best;
}

}  // namespace

bool rests_standing(const Skeleton& skeleton) {
  // A cosine: 45 degrees, beyond which no rest pose of a standing body goes.
  constexpr double kAbout = 0.7;
  const Joints joints = joints_of(skeleton);
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  const View view(joints, rest);
  const glm::dvec3 left = view.place(B::kLeftUpperLeg) - view.place(B::kRightUpperLeg);
  if (left.x < kAbout * glm::length(left)) return false;
  for (const B leg : kUpperLegs) {
    if (-view.direction(leg, lower_of(leg)).y < kAbout) return false;
    if (-view.direction(lower_of(leg), end_of(leg)).y < kAbout) return false;
  }
  const B top = top_of_trunk(joints);
  return top == B::kHips || view.direction(B::kHips, top).y > kAbout;
}

Skeleton standing_rest(const Motion& motion) {
  MAREY_ASSERT(!motion.poses.empty());
  const Joints joints = joints_of(motion.skeleton);
  const BestLooks best = find_looks(motion, joints);
  const std::vector<Part> parts = parts_of(motion.skeleton, joints);

  Skeleton out = motion.skeleton;
  std::vector<glm::dquat> rest(out.joints.size());
  double ankle_height_m = 0.0;
  for (std::size_t part = 0; part < kPartCount; ++part) {
    const auto world_from_joint =
        world_from_joints(motion.skeleton, motion.poses[best.frame[part]]);
    const View view(joints, world_from_joint);
    for (std::size_t j = 0; j < rest.size(); ++j) {
      if (parts[j] == part) rest[j] = view.forward() * world_from_joint[j].rotation;
    }
    if (part == kLeftFootPart) ankle_height_m += 0.5 * view.place(B::kLeftFoot).y;
    if (part == kRightFootPart) ankle_height_m += 0.5 * view.place(B::kRightFoot).y;
  }
  for (std::size_t j = 0; j < rest.size(); ++j) {
    Joint& joint = out.joints[j];
    joint.parent_from_joint.rotation = glm::normalize(
        joint.parent ? glm::conjugate(rest[index(*joint.parent)]) * rest[j] : rest[j]);
    if (!joint.parent) joint.parent_from_joint.translation = glm::dvec3(0.0);
  }
  const auto placed = world_from_joints(out, rest_pose(out));
  const auto place = [&](B bone) { return placed[index(*joints[index(bone)])].translation; };
  glm::dvec3& root = out.joints.front().parent_from_joint.translation;
  const glm::dvec3 hips = place(B::kHips);
  const double ankles_m = 0.5 * (place(B::kLeftFoot).y + place(B::kRightFoot).y);
  root = {-hips.x, ankle_height_m - ankles_m, -hips.z};
  return out;
}

}  // namespace marey::retarget
