// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: covariance of the postures of a window.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <ceres/ceres.h>

#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {

/// Standard deviation of every bone's origin, per coordinate (point_sigma.h). [m]
using BoneSigmas = std::array<double, kHumanBoneCount>;

/// Standard deviation of every tag's centre, per coordinate, by position in
/// BodyModel::tags. [m]
using TagSigmas = std::vector<double>;

/// Computes the covariance of each free posture of the problem over Ceres' tangent space:
/// the diagonal blocks of the inverse of the problem's normal matrix. That matrix is
/// block pentadiagonal in time, so it is inverted by blocks of two frames in one forward
/// and one backward pass (Takahashi's equations). `postures` are the free ones, in time
/// order. nullopt if Ceres cannot evaluate the problem or the matrix is not positive
/// definite.
[[nodiscard]] std::optional<std::vector<Eigen::MatrixXd>> posture_covariances(
    std::span<Posture> postures, ceres::Problem& problem);

/// Compute the sigmas of one posture with this covariance. The body is assumed to be
/// exact.
[[nodiscard]] BoneSigmas bone_sigmas(const BodyModel& model,
                                     const Posture& posture,
                                     const Eigen::MatrixXd& covariance);
[[nodiscard]] TagSigmas tag_sigmas(const BodyModel& model,
                                   const Posture& posture,
                                   const Eigen::MatrixXd& covariance);

}  // namespace marey::reconstruct
