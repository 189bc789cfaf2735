// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/joint_evidence.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "reconstruct/length_terms.h"

namespace marey::reconstruct {
namespace {

using Eigen::Vector3d;

// A joint that turned so far, and whose place is then known so much better than from an
// average person's, was found by its movement.
constexpr double kEnoughRange_rad = 0.35;
constexpr double kTellingShare = 0.5;

/// How far a bone was turned against its parent, from its middle attitude: between the
/// 5th and the 95th percent along the axis about which it turned most. [rad]
double range_of(const MarkerBundle& bundle,
                std::span<const Snapshot> snapshots,
                HumanBone bone,
                HumanBone up) {
  std::vector<Vector3d> turns;
  UnfoldedPosture unfolded;
  for (const Snapshot& snapshot : snapshots) {
    if (!snapshot.solved) continue;
    unfolded.unfold(snapshot.posture, bundle.model.lengths, bundle.model.body);
    const Eigen::Matrix3d turn =
        unfolded.rotation(up).transpose() * unfolded.rotation(bone);
    const Eigen::AngleAxisd angle_axis(turn);
    turns.push_back(angle_axis.angle() * angle_axis.axis());
  }
  double widest = 0.0;
  for (int axis = 0; axis < 3 && !turns.empty(); ++axis) {
    std::vector<double> values;
    for (const Vector3d& turn : turns) values.push_back(turn[axis]);
    std::sort(values.begin(), values.end());
    const std::size_t tail = values.size() / 20;
    widest = std::max(widest, values[values.size() - 1 - tail] - values[tail]);
  }
  return widest;
}

}  // namespace

std::vector<JointEvidence> joint_evidence(const MarkerBundle& bundle,
                                          std::span<const Snapshot> snapshots,
                                          const Proportions& average,
                                          const std::vector<bool>& exact) {
  std::vector<JointEvidence> joints;
  for (const HumanBone bone : human_bones()) {
    if (bone == HumanBone::kHips) continue;
    JointEvidence joint;
    joint.joint = bone;
    const HumanBone up = *parent(bone);
    const auto length = length_of(bone);
    const double prior_m = length ? bundle.usual_sigma_m[index(*length)]
                                  : usual_length_sigma_m(glm::length(average[bone]));
    // Of a joint whose length is not moved, the average is all there is.
    joint.sigma_m = length ? bundle.length_sigma_m[index(*length)] : prior_m;
    joint.range_rad = range_of(bundle, snapshots, bone, up);
    const bool landmarks = std::any_of(
        bundle.model.markers.begin(), bundle.model.markers.end(), [&](const auto& m) {
          const std::size_t at =
              static_cast<std::size_t>(&m - bundle.model.markers.data());
          return exact[at] && (m.bone == bone || m.bone == up);
        });
    if (length && joint.range_rad > kEnoughRange_rad &&
        joint.sigma_m < kTellingShare * prior_m) {
      joint.origin = JointOrigin::kMovement;
    } else if (length && landmarks && joint.sigma_m < kTellingShare * 2.0 * prior_m) {
      joint.origin = JointOrigin::kLandmarks;
    } else {
      joint.origin = JointOrigin::kProportions;
    }
    joints.push_back(joint);
  }
  return joints;
}

std::string_view name(JointOrigin origin) {
  switch (origin) {
    case JointOrigin::kMovement:
      return "movement";
    case JointOrigin::kLandmarks:
      return "landmarks";
    case JointOrigin::kProportions:
      return "proportions";
  }
  return "proportions";
}

}  // namespace marey::reconstruct
