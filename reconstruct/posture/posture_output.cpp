// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_output.h"

#include <cmath>

#include "reconstruct/clusters/sightings.h"
#include "reconstruct/posture/point_sigma.h"

namespace marey::reconstruct {

void to_pose(const UnfoldedPosture& unfolded, const Skeleton& skeleton, Pose& out) {
  out.parent_from_joint.resize(skeleton.joints.size());
  const Eigen::Vector3d& root = unfolded.origin(HumanBone::kHips);
  out.root_in_world = {root.x(), root.y(), root.z()};
  for (const HumanBone bone : human_bones()) {
    const auto up = parent(bone);
    const Eigen::Matrix3d own =
        up ? Eigen::Matrix3d(unfolded.rotation(*up).transpose() * unfolded.rotation(bone))
           : unfolded.rotation(bone);
    const Eigen::Quaterniond q = Eigen::Quaterniond(own).normalized();
    out.parent_from_joint[index(bone)] = {q.w(), q.x(), q.y(), q.z()};
  }
}

void joint_sigmas(const UnfoldedPosture& unfolded,
                  const Body& body,
                  const PostureCovariance& covariance,
                  std::array<double, kHumanBoneCount>& out) {
  SparseDerivative derivative;
  for (const HumanBone bone : human_bones()) {
    const HumanBone mover = solved_segment(bone);
    Eigen::Vector3d origin = unfolded.origin(mover);
    if (mover != bone) origin = unfolded.point(mover, eigen(body.proportions[bone]));
    unfolded.derivative(mover, origin, derivative);
    out[index(bone)] = std::hypot(point_sigma_m(covariance.of(derivative)),
                                  body.joint_centre_sigma_m[index(bone)]);
  }
}

}  // namespace marey::reconstruct
