// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/joint_evidence.h"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "core/human/posture_priors.h"
#include "reconstruct/posture/length_terms.h"

namespace marey::reconstruct {
namespace {

using Eigen::Vector3d;

// The source of a joint is movement if it was turned this far and its sigma is this share
// of the prior's.
constexpr double kEnoughRange_rad = 0.35;
constexpr double kMovementShare = 0.5;
// Landmarks next to a joint have improved it if its sigma is below this share of the
// prior's.
constexpr double kInformedShare = 0.9;

/// Returns the range of a bone's rotation relative to its parent, from its middle
/// attitude: between the 5th and the 95th percentile along the axis about which it turned
/// most. [rad]
double range_of(const MarkerBundle& bundle,
                std::span<const Snapshot> snapshots,
                HumanBone bone,
                HumanBone up) {
  std::vector<Eigen::Quaterniond> turns;
  Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
  UnfoldedPosture unfolded;
  for (const Snapshot& snapshot : snapshots) {
    if (!snapshot.solved) continue;
    unfolded.unfold(snapshot.posture, bundle.model.lengths, bundle.model.body);
    turns.emplace_back(unfolded.rotation(up).transpose() * unfolded.rotation(bone));
    scatter += turns.back().coeffs() * turns.back().coeffs().transpose();
  }
  if (turns.empty()) return 0.0;
  // The middle attitude: the mean quaternion (Markley et al. 2007).
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> means(scatter);
  const Eigen::Quaterniond middle(Eigen::Vector4d(means.eigenvectors().col(3)));
  std::vector<Vector3d> off;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Quaterniond& turn : turns) {
    off.push_back(log_of(middle.conjugate() * turn));
    spread += off.back() * off.back().transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Vector3d axis = axes.eigenvectors().col(2);
  std::vector<double> angles;
  for (const Vector3d& turn : off) angles.push_back(axis.dot(turn));
  std::sort(angles.begin(), angles.end());
  const std::size_t tail = angles.size() / 20;
  return angles[angles.size() - 1 - tail] - angles[tail];
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
                                  : length_sigma_m(glm::length(average[bone]));
    // For a joint whose length is held, the average is the only source.
    joint.sigma_m = length ? bundle.length_sigma_m[index(*length)] : prior_m;
    joint.range_rad = range_of(bundle, snapshots, bone, up);
    const bool landmarks = std::any_of(
        bundle.model.markers.begin(), bundle.model.markers.end(), [&](const auto& m) {
          const std::size_t at =
              static_cast<std::size_t>(&m - bundle.model.markers.data());
          return exact[at] && (m.bone == bone || m.bone == up);
        });
    if (length && joint.range_rad > kEnoughRange_rad &&
        joint.sigma_m < kMovementShare * prior_m) {
      joint.origin = JointOrigin::kMovement;
    } else if (length && landmarks && joint.sigma_m < kInformedShare * prior_m) {
      joint.origin = JointOrigin::kLandmarks;
    } else {
      joint.origin = JointOrigin::kProportions;
    }
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace marey::reconstruct
