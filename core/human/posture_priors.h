// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

#include "core/base/time.h"

/// Priors of human postures, movements and lengths. The solvers of reconstruct/ use them,
/// and the plans of calib/ predict the errors of these solvers with the same numbers.
/// They are wide compared with measurements, and matter only for unknowns that no
/// measurement determines. Rotations are rotation vectors [rad]; sigmas are standard
/// deviations.
namespace marey {

/// Spine: the end of the abdomen lies half way between hips and thorax, and the neck half
/// way between thorax and head.
inline constexpr double kAbdomenBendSigma_rad = 0.12;
inline constexpr double kNeckBendSigma_rad = 0.15;
/// Rotation of the thorax relative to the hips, and of the head relative to the thorax.
inline constexpr double kTrunkTurnSigma_rad = 0.7;
/// Rotation of a collar bone relative to the thorax, about its own axes. It does not
/// rotate about its long axis X; only its skin does.
inline constexpr glm::dvec3 kCollarBoneSigma_rad{0.1, 0.25, 0.25};

/// Usual angle of the arms below the T-pose: 70 degrees.
inline constexpr double kHangingArm_rad = 1.2217304763960306;
/// Rotation of a limb relative to its usual direction.
inline constexpr double kArmSigma_rad = 1.0;
inline constexpr double kLegSigma_rad = 0.8;
/// Elbows and knees are slightly bent, and do not bend backward.
inline constexpr double kUsualFlexion_rad = 0.3;
inline constexpr double kFlexionSigma_rad = 1.0;
inline constexpr double kMinFlexion_rad = -0.05;
inline constexpr double kMinFlexionSigma_rad = 0.1;
/// Rotation of hands and feet relative to the direction of the bone before them.
inline constexpr double kHandSigma_rad = 0.5;
inline constexpr double kFootSigma_rad = 0.35;
/// Twist of skin about its bones; in forearms also pronation.
inline constexpr double kArmTwistSigma_rad = 0.4;
inline constexpr double kLegTwistSigma_rad = 0.08;
/// Twist of an arm's skin while a subject is fitted. Over a range-of-motion trial, elbows
/// bend about one axis of the arm's skin; with a free twist of the bone, the elbow's
/// position along that axis would not be determined.
inline constexpr double kFitTwistSigma_rad = 0.1;

/// A subject who was asked to stand still and upright: deviation of hips, thorax and head
/// from upright, of feet from flat, of the abdomen's end from half way, of the head and
/// the collar bones from the thorax, of hands and feet from the bone before them, and
/// twist of the limbs.
inline constexpr double kStandingTrunkSigma_rad = 0.03;
inline constexpr double kStandingFootSigma_rad = 0.02;
inline constexpr double kStandingBendSigma_rad = 0.03;
inline constexpr double kStandingTurnSigma_rad = 0.1;
inline constexpr double kStandingHandSigma_rad = 0.1;
inline constexpr double kStandingAnkleSigma_rad = 0.15;
inline constexpr double kStandingTwistSigma_rad = 0.02;

/// White-noise acceleration, [m/s^2] or [rad/s^2] at 30 frames per second: that of quick
/// everyday movement. A jump's landing exceeds it by a small factor for a frame or two,
/// which the measurements then determine.
inline constexpr double kHipsAcceleration_m_s2 = 10.0;
/// Hips, end of the abdomen, thorax and collar bones.
inline constexpr double kTrunkAcceleration_rad_s2 = 30.0;
inline constexpr double kNeckAcceleration_rad_s2 = 40.0;
inline constexpr double kHeadAcceleration_rad_s2 = 50.0;
inline constexpr double kArmAcceleration_rad_s2 = 70.0;
inline constexpr double kLegAcceleration_rad_s2 = 60.0;
inline constexpr double kHandAcceleration_rad_s2 = 110.0;
inline constexpr double kFootAcceleration_rad_s2 = 90.0;
inline constexpr double kFlexionAcceleration_rad_s2 = 80.0;
inline constexpr double kUpperArmTwistAcceleration_rad_s2 = 40.0;
inline constexpr double kForearmTwistAcceleration_rad_s2 = 60.0;
inline constexpr double kLegTwistAcceleration_rad_s2 = 30.0;

/// The change of an unknown from frame to frame is an Ornstein-Uhlenbeck process: the
/// next change is `correlation` times the last, plus noise of standard deviation `sigma`,
/// [m] or [rad] per frame.
struct StepProcess {
  double sigma = 0.0;
  double correlation = 0.0;
};

/// Returns the process of a rotation or an angle with the given white-noise acceleration;
/// its correlation time is a quarter of a second.
/// Preconditions: rate.hz > 0, correlation_time_s > 0.
/// Cost: a square root and an exponential.
[[nodiscard]] inline StepProcess step_process(double acceleration,
                                              FrameRate rate,
                                              double correlation_time_s = 0.25) {
  const double dt = 1.0 / rate.hz;
  // The variance of a second difference of integrated white noise grows with the cube of
  // dt.
  return {acceleration * std::sqrt(dt * dt * dt / 30.0),
          std::exp(-dt / correlation_time_s)};
}

/// Returns the process of the position of the hips; its correlation time is one second.
[[nodiscard]] inline StepProcess hips_step_process(FrameRate rate) {
  return step_process(kHipsAcceleration_m_s2, rate, 1.0);
}

/// Returns the standard deviation in people of a length whose average is `average_m`.
[[nodiscard]] inline double length_sigma_m(double average_m) {
  return std::max(0.012, 0.10 * average_m);
}
/// Difference between the lengths of the left and the right side.
inline constexpr double kSidesDifferSigma_m = 0.008;

}  // namespace marey
