// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/exchanged_limbs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/quantile.h"
#include "reconstruct/segments/cluster_geometry.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

/// The mean of votes between -1 and 1, and their number.
struct Votes {
  double sum = 0.0;
  int count = 0;

  void add(double vote) {
    sum += vote;
    ++count;
  }
  [[nodiscard]] double mean() const { return count == 0 ? 0.0 : sum / count; }
};

/// The directions of a standing body's segments.
class Facing {
 public:
  Facing(const SegmentFrames& found,
         std::span<const TagCluster> clusters,
         std::span<const ClusterPoses> standing,
         std::span<const ClusterPoses> moving)
      : found_(found),
        clusters_(clusters),
        standing_(medoid_poses(standing)),
        moving_(moving) {}

  [[nodiscard]] std::optional<glm::dquat> world_from(B bone) const {
    const auto pose = standing_.find(bone);
    const auto known = found_.segment_from_cluster.find(bone);
    if (pose == standing_.end() || known == found_.segment_from_cluster.end()) {
      return std::nullopt;
    }
    return pose->second.rotation * glm::conjugate(known->second.rotation);
  }

  [[nodiscard]] glm::dvec3 forward(B trunk) const {
    return world_from(trunk).value_or(glm::dquat(1, 0, 0, 0)) * glm::dvec3(0, 0, 1);
  }

  /// Returns votes on the legs' direction: 1 is the hips' forward, -1 is backward. Thighs
  /// face forward, since knees bend backward; tags of feet are in front of their ankles.
  [[nodiscard]] Votes legs() const {
    Votes votes;
    for (const std::size_t limb : {2UL, 3UL}) {
      if (bends(limb)) {
        if (const auto thigh = world_from(human_limbs()[limb].upper)) {
          votes.add(glm::dot(*thigh * glm::dvec3(0, 0, 1), forward(B::kHips)));
        }
      }
    }
    for (const std::size_t limb : {2UL, 3UL}) add_foot(limb, votes);
    return votes;
  }

 private:
  /// Returns whether the limb bends far enough to show the sign of its hinge.
  [[nodiscard]] bool bends(std::size_t limb) const {
    constexpr double kFar_rad = 0.6;
    const HumanLimb& bones = human_limbs()[limb];
    std::vector<double> bend;
    for (const ClusterPoses& frame : moving_) {
      const auto upper = frame.find(bones.upper);
      const auto lower = frame.find(bones.lower);
      if (upper == frame.end() || lower == frame.end()) continue;
      const glm::dvec3 along = direction(limb);
      const glm::dvec3 u = axis(bones.upper, upper->second, along);
      const glm::dvec3 l = axis(bones.lower, lower->second, along);
      bend.push_back(std::acos(std::clamp(glm::dot(u, l), -1.0, 1.0)));
    }
    return bend.size() >= 10 && quantile(bend, 0.95) > kFar_rad;
  }

  static glm::dvec3 direction(std::size_t limb) {
    return limb < 2 ? glm::dvec3(limb == 0 ? 1.0 : -1.0, 0, 0) : glm::dvec3(0, -1, 0);
  }

  [[nodiscard]] glm::dvec3 axis(B bone,
                                const RigidTransform& pose,
                                const glm::dvec3& along) const {
    return pose.rotation *
           (glm::conjugate(found_.segment_from_cluster.at(bone).rotation) * along);
  }

  void add_foot(std::size_t limb, Votes& votes) const {
    // Nearer to the ankle a tag can be on any side of it.
    constexpr double kBefore_m = 0.05;
    const B foot = human_limbs()[limb].end;
    const auto pose = standing_.find(foot);
    const auto known = found_.segment_from_cluster.find(foot);
    if (pose == standing_.end() || known == found_.segment_from_cluster.end()) return;
    const glm::dvec3 ankle = pose->second * (inverse(known->second).translation);
    for (const TagCluster& cluster : clusters_) {
      if (cluster.segment != foot) continue;
      glm::dvec3 middle(0.0);
      for (const auto& [tag, cluster_from_tag] : cluster.cluster_from_tag) {
        middle += cluster_from_tag.translation /
                  static_cast<double>(cluster.cluster_from_tag.size());
      }
      glm::dvec3 before = pose->second * middle - ankle;
      before.y = 0.0;
      if (glm::length(before) < kBefore_m) continue;
      votes.add(glm::dot(glm::normalize(before), forward(B::kHips)));
    }
  }

  const SegmentFrames& found_;
  std::span<const TagCluster> clusters_;
  std::map<B, RigidTransform> standing_;
  std::span<const ClusterPoses> moving_;
};

Renaming mirrored_limbs(std::span<const std::size_t> left_limbs) {
  Renaming names;
  for (const std::size_t limb : left_limbs) {
    const HumanLimb& bones = human_limbs()[limb];
    for (const B bone : {bones.upper, bones.lower, bones.end}) {
      names[bone] = mirrored(bone);
      names[mirrored(bone)] = bone;
    }
  }
  names[B::kLeftShoulder] = B::kRightShoulder;
  names[B::kRightShoulder] = B::kLeftShoulder;
  if (std::count(left_limbs.begin(), left_limbs.end(), 0UL) == 0) {
    names.erase(B::kLeftShoulder);
    names.erase(B::kRightShoulder);
  }
  return names;
}

}  // namespace

Result<Renaming> exchanged_limbs(const SegmentFrames& found,
                                 std::span<const TagCluster> clusters,
                                 std::span<const ClusterPoses> standing,
                                 std::span<const ClusterPoses> moving) {
  // The cosine of 60 degrees. In a standing body hips turn by less against the chest, and
  // knees against the hips.
  constexpr double kSure = 0.5;
  const Facing facing(found, clusters, standing, moving);
  const double trunk = glm::dot(facing.forward(B::kHips), facing.forward(B::kUpperChest));
  const Votes legs = facing.legs();
  const bool is_trunk_turned = trunk < -kSure;
  const bool are_legs_turned = legs.count > 0 && legs.mean() < -kSure;
  constexpr std::array<std::size_t, 2> kBoth{0, 2};
  if (trunk > kSure && are_legs_turned) return mirrored_limbs(kBoth);
  if (is_trunk_turned && are_legs_turned) return mirrored_limbs(std::span(kBoth).last(1));
  const bool are_legs_right = legs.count > 0 && legs.mean() > kSure;
  if (is_trunk_turned && are_legs_right) {
    return mirrored_limbs(std::span(kBoth).first(1));
  }
  if (!is_trunk_turned) return Renaming();
  return bad_input("[[tags.tag]]",
                   "chest and hips face opposite ways: left and right look exchanged "
                   "on the arms, on the legs or on some of their segments",
                   "compare the `segment` of the tags on arms and legs with where they "
                   "are worn; left is the subject's left");
}

}  // namespace marey::reconstruct
