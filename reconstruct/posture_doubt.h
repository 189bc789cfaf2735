// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how well a window's postures are known.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <ceres/ceres.h>

#include "reconstruct/body_model.h"

namespace marey::reconstruct {

/// Standard deviation of every bone's origin, per coordinate (point_sigma.h). [m]
using BoneSigmas = std::array<double, kHumanBoneCount>;

/// Of every tag's centre, likewise, by position in BodyModel::tags. [m]
using TagSigmas = std::vector<double>;

/// Covariance of each posture that the problem moves, over its tangent, Ceres' own: the
/// diagonal blocks of the inverse of the problem's normal matrix. That matrix is block
/// pentadiagonal in time, so it is inverted by blocks of two frames in one forward and
/// one backward pass (Takahashi's equations). `postures` are the moving ones, in time
/// order. nullopt when Ceres cannot evaluate or the matrix is not positive definite.
[[nodiscard]] std::optional<std::vector<Eigen::MatrixXd>> posture_covariances(
    std::span<Posture> postures, ceres::Problem& problem);

/// Of one posture with this covariance. The body itself is taken as known.
[[nodiscard]] BoneSigmas bone_sigmas(const BodyModel& model,
                                     const Posture& posture,
                                     const Eigen::MatrixXd& covariance);
[[nodiscard]] TagSigmas tag_sigmas(const BodyModel& model,
                                   const Posture& posture,
                                   const Eigen::MatrixXd& covariance);

}  // namespace marey::reconstruct
