// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: derivatives of the bone frames of a planned body by its posture and
// lengths, and the priors of both. The unknowns are those of marey's own solver
// (reconstruct/posture/posture.h); their priors and speeds come from
// core/human/posture_priors.h, as the solver's do: other priors would predict errors that
// the solver does not achieve.

#include <array>

#include <Eigen/Dense>

#include "calib/plan/planned_body.h"
#include "core/base/time.h"

namespace marey::calib {

/// Columns of a posture: position of the hips, then rotation vectors in the world of
/// hips, end of the abdomen, thorax, neck, head and collar bones; per limb its frame (3),
/// flexion, twist of the upper and of the lower bone, and its extremity (3).
inline constexpr int kPostureColumns = 60;
/// Lengths that a subject's fit solves for: trunk and neck (5), half the hips' width,
/// collar bones, then upper and lower bone of each limb by pairs, left before right.
inline constexpr int kLengthColumns = 16;
/// Origins of the collar bones on the rib cage, left and right: not observable from tags,
/// so average values are used.
inline constexpr int kBaseColumns = 6;
/// Positions of small body parts are known to about 1 cm.
inline constexpr double kBaseSigma_m = 0.012;

using PostureMatrix = Eigen::Matrix<double, kPostureColumns, kPostureColumns>;
using PostureVector = Eigen::Matrix<double, kPostureColumns, 1>;

/// Derivatives of each bone's frame in the world by the columns: of its rotation vector
/// (`spin`) by the posture, and of its origin [m] by posture, lengths and collar bones.
struct PostureJacobian {
  std::array<Eigen::Matrix<double, 3, kPostureColumns>, kHumanBoneCount> spin;
  std::array<Eigen::Matrix<double, 3, kPostureColumns>, kHumanBoneCount> origin;
  std::array<Eigen::Matrix<double, 3, kLengthColumns>, kHumanBoneCount> origin_by_length;
  std::array<Eigen::Matrix<double, 3, kBaseColumns>, kHumanBoneCount> origin_by_base;
};

/// Computes the derivatives of all bone frames, in the world. Precondition: in `place`, a
/// posture of `body`, no limb's upper bone is twisted out of the plane in which the limb
/// bends.
[[nodiscard]] PostureJacobian posture_jacobian(const PlannedBody& body,
                                               const BodyPlace& place);

/// Derivatives of the residuals of a posture prior by the posture's columns, each divided
/// by its sigma. Expected values are not included.
using PosturePriorRows = Eigen::Matrix<double, Eigen::Dynamic, kPostureColumns>;

/// Returns the posture prior. `arm_twist_rad`: rotation of an arm's skin about its bone.
[[nodiscard]] PosturePriorRows posture_prior_rows(const BodyPlace& place,
                                                  const PostureJacobian& jacobian,
                                                  double arm_twist_rad);

/// Returns the additional prior of a subject who was asked to stand still and upright.
[[nodiscard]] PosturePriorRows standing_prior_rows(const BodyPlace& place,
                                                   const PostureJacobian& jacobian);

/// Prior of the step of each column from frame to frame: `correlation` times the previous
/// step, with standard deviation `sigma`.
struct StepPrior {
  PostureVector sigma;
  PostureVector correlation;
};

/// Returns the prior of the steps at `rate`.
[[nodiscard]] StepPrior step_prior(FrameRate rate);

/// Returns the information (inverse covariance) on the lengths from anthropometry and
/// from left-right symmetry. [1/m^2]
[[nodiscard]] Eigen::Matrix<double, kLengthColumns, kLengthColumns> length_information(
    const PlannedBody& body);

}  // namespace marey::calib
