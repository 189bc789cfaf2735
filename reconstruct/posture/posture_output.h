// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: poses and joint sigmas from solved postures.

#include <array>

#include "core/body.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/posture/posture_equations.h"

namespace marey::reconstruct {

/// Writes the pose of make_humanoid() in this posture. Keeps the storage of `out`.
void to_pose(const UnfoldedPosture& unfolded, const Skeleton& skeleton, Pose& out);

/// Computes the standard deviation of every bone's origin, per coordinate
/// (point_sigma.h), the body's own sigmas added. [m]
void joint_sigmas(const UnfoldedPosture& unfolded,
                  const Body& body,
                  const PostureCovariance& covariance,
                  std::array<double, kHumanBoneCount>& out);

}  // namespace marey::reconstruct
