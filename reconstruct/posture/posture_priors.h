// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: priors of human postures. They are wide compared with
// measurements and matter only for parameters that no measurement determines.

#include <array>
#include <cmath>

#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

/// Anatomical prior: a part of the spine bends evenly, so that `middle` is half way
/// between its ends.
struct SpineBendPrior {
  PoseParameter lower;
  PoseParameter middle;
  PoseParameter upper;
  double sigma_rad;
};
inline constexpr std::array<SpineBendPrior, 2> kSpineBendPriors{{
    {PoseParameter::kHips, PoseParameter::kAbdomenEnd, PoseParameter::kThorax, 0.12},
    {PoseParameter::kThorax, PoseParameter::kNeck, PoseParameter::kHead, 0.15},
}};

/// Prior: `child` is rotated by `usual_rad` (a rotation vector) relative to `parent`.
struct RelativePosePrior {
  PoseParameter parent;
  PoseParameter child;
  glm::dvec3 usual_rad;
  glm::dvec3 sigma_rad;  ///< About the child's own axes.
  /// Anatomy rather than usual behaviour: the prior has full weight in every frame.
  bool anatomy = false;
};
/// Usual angle of the arms below the T-pose.
inline constexpr double kHangingArm_rad = 1.2217304763960306;  // 70 degrees
inline constexpr std::array<RelativePosePrior, 8> kRelativePosePriors{{
    {PoseParameter::kHips, PoseParameter::kThorax, {0, 0, 0}, {0.7, 0.7, 0.7}},
    {PoseParameter::kThorax, PoseParameter::kHead, {0, 0, 0}, {0.7, 0.7, 0.7}},
    // A collar bone does not rotate about its own axis; only its skin does.
    {PoseParameter::kThorax,
     PoseParameter::kLeftShoulder,
     {0, 0, 0},
     {0.1, 0.25, 0.25},
     true},
    {PoseParameter::kThorax,
     PoseParameter::kRightShoulder,
     {0, 0, 0},
     {0.1, 0.25, 0.25},
     true},
    {PoseParameter::kThorax,
     PoseParameter::kLeftArm,
     {0, 0, -kHangingArm_rad},
     {1, 1, 1}},
    {PoseParameter::kThorax,
     PoseParameter::kRightArm,
     {0, 0, kHangingArm_rad},
     {1, 1, 1}},
    {PoseParameter::kHips, PoseParameter::kLeftLeg, {0, 0, 0}, {0.8, 0.8, 0.8}},
    {PoseParameter::kHips, PoseParameter::kRightLeg, {0, 0, 0}, {0.8, 0.8, 0.8}},
}};

/// Elbows and knees are slightly bent, and do not bend backward.
inline constexpr double kUsualFlexion_rad = 0.3;
inline constexpr double kFlexionSigma_rad = 1.0;
inline constexpr double kMinFlexion_rad = -0.05;
inline constexpr double kMinFlexionSigma_rad = 0.1;

/// Returns the sigma of hands and feet about the direction of the bone before them. [rad]
[[nodiscard]] constexpr double extremity_sigma_rad(std::size_t limb) {
  return limb < 2 ? 0.5 : 0.35;
}
/// Standard deviations of the twist of skin about its bones, in forearms also of
/// pronation. [rad]
struct TwistPriors {
  double upper_arm = 0.4;
  double forearm = 0.4;
  double leg = 0.08;
};

/// White-noise acceleration of a pose parameter, [m/s^2] or [rad/s^2] at 30 frames per
/// second: that of quick everyday movement. A jump's landing exceeds it by a small factor
/// for a frame or two, which the measurements then determine.
struct PoseParameterAcceleration {
  PoseParameter parameter;
  double sigma;
};
inline constexpr std::array<PoseParameterAcceleration, kPoseParameterCount>
    kAccelerations{{
        {PoseParameter::kHipsPosition, 10.0},
        {PoseParameter::kHips, 30.0},
        {PoseParameter::kAbdomenEnd, 30.0},
        {PoseParameter::kThorax, 30.0},
        {PoseParameter::kNeck, 40.0},
        {PoseParameter::kHead, 50.0},
        {PoseParameter::kLeftShoulder, 30.0},
        {PoseParameter::kRightShoulder, 30.0},
        {PoseParameter::kLeftArm, 70.0},
        {PoseParameter::kRightArm, 70.0},
        {PoseParameter::kLeftLeg, 60.0},
        {PoseParameter::kRightLeg, 60.0},
        {PoseParameter::kLeftHand, 110.0},
        {PoseParameter::kRightHand, 110.0},
        {PoseParameter::kLeftFoot, 90.0},
        {PoseParameter::kRightFoot, 90.0},
        {PoseParameter::kLeftElbow, 80.0},
        {PoseParameter::kRightElbow, 80.0},
        {PoseParameter::kLeftKnee, 80.0},
        {PoseParameter::kRightKnee, 80.0},
        {PoseParameter::kLeftForearmTwist, 60.0},
        {PoseParameter::kRightForearmTwist, 60.0},
        {PoseParameter::kLeftShankTwist, 30.0},
        {PoseParameter::kRightShankTwist, 30.0},
        {PoseParameter::kLeftUpperArmTwist, 40.0},
        {PoseParameter::kRightUpperArmTwist, 40.0},
        {PoseParameter::kLeftThighTwist, 30.0},
        {PoseParameter::kRightThighTwist, 30.0},
    }};

/// The speed of a pose parameter from frame to frame: an Ornstein-Uhlenbeck process.
struct StepProcess {
  double sigma;  ///< Standard deviation of the change of a step from one frame to the
                 ///< next.
  double correlation;  ///< Correlation of consecutive steps: the share of a step that the
                       ///< next one inherits.
};

[[nodiscard]] inline StepProcess process_of(const PoseParameterAcceleration& row,
                                            FrameRate rate) {
  const double dt = 1.0 / rate.hz;
  const double memory_s = row.parameter == PoseParameter::kHipsPosition ? 1.0 : 0.25;
  // The variance of a second difference of integrated white noise grows with the cube of
  // dt.
  return {row.sigma * std::sqrt(dt * dt * dt / 30.0), std::exp(-dt / memory_s)};
}

}  // namespace marey::reconstruct
