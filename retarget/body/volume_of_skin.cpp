// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/volume_of_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/body/support_points.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

constexpr std::size_t kMinPoints = 12;
constexpr double kWithin = 0.97;  // Share of a trunk's vertices within its breadth.
constexpr std::array kTrunkParts{P::kPelvis, P::kAbdomen, P::kChest};

// Returns the part of a limb or head that a marked bone carries.
std::optional<P> volume_part_of(B bone) {
  switch (bone) {
    case B::kHead:
      return P::kHead;
    case B::kLeftUpperArm:
      return P::kLeftUpperArm;
    case B::kLeftLowerArm:
      return P::kLeftForearm;
    case B::kLeftHand:
      return P::kLeftHand;
    case B::kLeftUpperLeg:
      return P::kLeftThigh;
    case B::kLeftLowerLeg:
      return P::kLeftShank;
    case B::kRightUpperArm:
      return P::kRightUpperArm;
    case B::kRightLowerArm:
      return P::kRightForearm;
    case B::kRightHand:
      return P::kRightHand;
    case B::kRightUpperLeg:
      return P::kRightThigh;
    case B::kRightLowerLeg:
      return P::kRightShank;
    default:
      return std::nullopt;
  }
}

enum class Belongs { kNowhere, kPart, kTrunk };
struct SkinOwner {
  Belongs belongs = Belongs::kNowhere;
  P part = P::kHead;
};

// Unmarked joints (fingers, twists) belong to their nearest marked ancestor.
std::vector<SkinOwner> skin_owners(const Skeleton& skeleton, const BodyMap& map) {
  std::vector<SkinOwner> owners(skeleton.joints.size());
  for (std::size_t i = 0; i < owners.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const JointIndex self{static_cast<int>(i)};
    const bool vertebra = map.joints[i].role == JointRole::kVertebra;
    if (self == map.hips() || vertebra) {
      owners[i] = {Belongs::kTrunk, P::kPelvis};
    } else if (!joint.bone) {
      if (joint.parent) owners[i] = owners[index(*joint.parent)];
    } else if (const auto part = volume_part_of(*joint.bone)) {
      owners[i] = {Belongs::kPart, *part};
    }
  }
  return owners;
}

using Cloud = std::vector<glm::dvec3>;  // In a capsule's frame. [m]

void fit_round(const Cloud& cloud, Capsule& capsule) {
  std::vector<double> off_m;
  for (const glm::dvec3& p : cloud) {
    if (std::abs(p.z) <= capsule.half_length_m) off_m.push_back(std::hypot(p.x, p.y));
  }
  if (off_m.size() >= kMinPoints) capsule.radius_m = median(std::move(off_m));
}

// Takes half of the thinner of the two extents across; from the wrist to the finger tips.
void fit_hand(const Cloud& cloud, Capsule& capsule) {
  const auto values = [&](int axis) {
    std::vector<double> out;
    for (const glm::dvec3& p : cloud) out.push_back(p[axis]);
    return out;
  };
  const auto half_extent = [&](int axis) {
    return 0.5 *
           (quantile(values(axis), kWithin) - quantile(values(axis), 1.0 - kWithin));
  };
  const double thin_m = std::min(half_extent(0), half_extent(1));
  if (thin_m <= 0.0) return;
  const double wrist_m = -capsule.half_length_m - capsule.radius_m;
  const double tips_m = quantile(values(2), kWithin);
  capsule.radius_m = std::min(thin_m, std::max(0.5 * (tips_m - wrist_m), 0.25 * thin_m));
  capsule.half_length_m = std::max(0.5 * (tips_m - wrist_m) - capsule.radius_m, 0.0);
  capsule.joint_from_capsule.translation =
      capsule.joint_from_capsule * glm::dvec3(0.0, 0.0, 0.5 * (tips_m + wrist_m));
}

// The capsule's axis runs left to right, its x axis to the front.
void fit_slice(const Cloud& cloud, Capsule& capsule) {
  std::vector<double> aside;
  std::vector<double> front;
  for (const glm::dvec3& p : cloud) {
    aside.push_back(std::abs(p.z));
    front.push_back(p.x);
  }
  const double back_m = quantile(front, 1.0 - kWithin);
  const double front_m = quantile(front, kWithin);
  const double radius_m = 0.5 * (front_m - back_m);
  if (radius_m <= 0.0) return;
  capsule.radius_m = radius_m;
  capsule.half_length_m = std::max(quantile(std::move(aside), kWithin) - radius_m, 0.0);
  capsule.joint_from_capsule.translation =
      capsule.joint_from_capsule * glm::dvec3(0.5 * (front_m + back_m), 0.0, 0.0);
}

}  // namespace

BodyVolume volume_of_skin(const Skeleton& skeleton,
                          const BodyMap& map,
                          std::span<const SkinPoint> skin) {
  BodyVolume out = average_volume(skeleton, map);
  const std::vector<SkinOwner> owners = skin_owners(skeleton, map);
  const std::vector<RigidTransform> rest =
      world_from_joints(skeleton, rest_pose(skeleton));
  std::array<Cloud, kVolumePartCount> clouds;
  const auto in_capsule = [&](const Capsule& capsule, const glm::dvec3& p) {
    return inverse(rest[index(capsule.joint)] * capsule.joint_from_capsule) * p;
  };
  for (const SkinPoint& point : skin) {
    MAREY_ASSERT(index(point.joint) < owners.size());
    const SkinOwner& owner = owners[index(point.joint)];
    if (owner.belongs == Belongs::kPart && out[owner.part]) {
      clouds[index(owner.part)].push_back(in_capsule(*out[owner.part], point.p_in_world));
    } else if (owner.belongs == Belongs::kTrunk) {
      // The slice whose middle is nearest in height.
      const auto height = [&](P part) {
        return std::abs(in_capsule(*out[part], point.p_in_world).y);
      };
      const P slice = *std::min_element(kTrunkParts.begin(),
                                        kTrunkParts.end(),
                                        [&](P a, P b) { return height(a) < height(b); });
      clouds[index(slice)].push_back(in_capsule(*out[slice], point.p_in_world));
    }
  }
  for (int i = 0; i < kVolumePartCount; ++i) {
    const P part = static_cast<P>(i);
    const Cloud& cloud = clouds[index(part)];
    if (!out[part] || cloud.size() < kMinPoints) continue;
    const bool trunk =
        std::find(kTrunkParts.begin(), kTrunkParts.end(), part) != kTrunkParts.end();
    if (trunk) {
      fit_slice(cloud, *out[part]);
    } else if (part == P::kLeftHand || part == P::kRightHand) {
      const RigidTransform joint_from_capsule = out[part]->joint_from_capsule;
      Cloud in_joint;
      for (const glm::dvec3& p : cloud) in_joint.push_back(joint_from_capsule * p);
      out.hand_skin_in_joint[part == P::kLeftHand ? 0 : 1] = support_points(in_joint);
      fit_hand(cloud, *out[part]);
    } else {
      fit_round(cloud, *out[part]);
    }
  }
  return out;
}

}  // namespace marey::retarget
