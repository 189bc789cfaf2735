// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: how a planned body can move, to first order, and what is known of it
// before anybody looks. The unknowns, their habits and their speeds are those that
// marey's own solver has (reconstruct/posture.h, posture_terms.cpp): a plan that knew
// more or less would promise what nobody delivers.

#include <array>

#include <Eigen/Dense>

#include "calib/planned_body.h"

namespace marey::calib {

/// Columns of a posture: hips' place, then rotation vectors in the world of hips,
/// abdomen's end, thorax, neck, head and collar bones; per limb its frame (3), flexion,
/// twist of the upper bone and of the lower, and its extremity (3).
inline constexpr int kPostureColumns = 60;
/// Lengths that a subject's fit moves: trunk and neck (5), half the hips' width, collar
/// bones, then upper and lower bone of each limb by pairs, left before right.
inline constexpr int kLengthColumns = 16;
/// Where the collar bones start on the rib cage, left and right: no tag tells, so it is
/// taken for average.
inline constexpr int kBaseColumns = 6;
inline constexpr double kBaseSigma_m = 0.012;  ///< Small parts are known to a centimetre.

using PostureMatrix = Eigen::Matrix<double, kPostureColumns, kPostureColumns>;
using PostureVector = Eigen::Matrix<double, kPostureColumns, 1>;

/// How each bone's frame follows the columns.
struct BodyMotion {
  std::array<Eigen::Matrix<double, 3, kPostureColumns>, kHumanBoneCount> spin;
  std::array<Eigen::Matrix<double, 3, kPostureColumns>, kHumanBoneCount> origin;
  std::array<Eigen::Matrix<double, 3, kLengthColumns>, kHumanBoneCount> origin_by_length;
  std::array<Eigen::Matrix<double, 3, kBaseColumns>, kHumanBoneCount> origin_by_base;
};

/// Precondition: `place` is a posture of `body` whose upper limbs are not twisted off the
/// plane in which the limb bends.
[[nodiscard]] BodyMotion motion_of(const PlannedBody& body, const BodyPlace& place);

/// What human habits say of a posture, a row each, in sigmas: "elbows are bent by 0.3,
/// give or take 1".
using HabitRows = Eigen::Matrix<double, Eigen::Dynamic, kPostureColumns>;

/// `arm_twist_rad`: how far the skin of an arm turns about its bone.
[[nodiscard]] HabitRows habits(const BodyPlace& place,
                               const BodyMotion& motion,
                               double arm_twist_rad);

/// What is known beside them of somebody who was asked to stand still and upright.
[[nodiscard]] HabitRows standing_habits(const BodyPlace& place, const BodyMotion& motion);

/// A step of each column from frame to frame is `keeps` times the last one, give or take
/// `sigma`.
struct StepPrior {
  PostureVector sigma;
  PostureVector keeps;
};

[[nodiscard]] StepPrior step_prior(double rate_hz);

/// Information on lengths from anthropometry and from both sides being alike.
[[nodiscard]] Eigen::Matrix<double, kLengthColumns, kLengthColumns> usual_lengths(
    const PlannedBody& body);

}  // namespace marey::calib
