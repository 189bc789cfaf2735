// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what is known of postures before anybody looks, as numbers.
// Wide next to any measurement; they decide only what is not seen.

#include <array>
#include <cmath>

#include <glm/vec3.hpp>

#include "core/time.h"
#include "reconstruct/posture.h"

namespace marey::reconstruct {

/// A part of the spine bends evenly: `middle` is half way between its ends. Anatomy.
struct HalfwayHabit {
  Slot lower;
  Slot middle;
  Slot upper;
  double sigma_rad;
};
inline constexpr std::array<HalfwayHabit, 2> kHalfwayHabits{{
    {Slot::kHips, Slot::kAbdomenEnd, Slot::kThorax, 0.12},
    {Slot::kThorax, Slot::kNeck, Slot::kHead, 0.15},
}};

/// `child` is usually turned by `usual_rad` (a rotation vector) against `parent`.
struct RelativeHabit {
  Slot parent;
  Slot child;
  glm::dvec3 usual_rad;
  glm::dvec3 sigma_rad;  ///< About the child's own axes.
  /// How joints are built rather than what people do with them: holds in every frame.
  bool anatomy = false;
};
/// How far arms hang down from the T-pose: usually.
inline constexpr double kHangingArm_rad = 1.2217304763960306;  // 70 degrees
inline constexpr std::array<RelativeHabit, 8> kRelativeHabits{{
    {Slot::kHips, Slot::kThorax, {0, 0, 0}, {0.7, 0.7, 0.7}},
    {Slot::kThorax, Slot::kHead, {0, 0, 0}, {0.7, 0.7, 0.7}},
    // About its own axis nothing of a collar bone moves but skin.
    {Slot::kThorax, Slot::kLeftShoulder, {0, 0, 0}, {0.1, 0.25, 0.25}, true},
    {Slot::kThorax, Slot::kRightShoulder, {0, 0, 0}, {0.1, 0.25, 0.25}, true},
    {Slot::kThorax, Slot::kLeftArm, {0, 0, -kHangingArm_rad}, {1, 1, 1}},
    {Slot::kThorax, Slot::kRightArm, {0, 0, kHangingArm_rad}, {1, 1, 1}},
    {Slot::kHips, Slot::kLeftLeg, {0, 0, 0}, {0.8, 0.8, 0.8}},
    {Slot::kHips, Slot::kRightLeg, {0, 0, 0}, {0.8, 0.8, 0.8}},
}};

/// Elbows and knees are a little bent, and do not bend backward.
inline constexpr double kUsualFlexion_rad = 0.3;
inline constexpr double kFlexionSigma_rad = 1.0;
inline constexpr double kLeastFlexion_rad = -0.05;
inline constexpr double kLeastFlexionSigma_rad = 0.1;

/// Hands and feet are in line with the bone before them, give or take.
[[nodiscard]] constexpr double extremity_sigma_rad(std::size_t limb) {
  return limb < 2 ? 0.5 : 0.35;
}
/// How far skin turns about its bones, and forearms' with pronation: standard deviations.
/// [rad]
struct TwistHabits {
  double upper_arm = 0.4;
  double forearm = 0.4;
  double leg = 0.08;
};

/// White-noise acceleration of a slot's speed, [m/s^2] or [rad/s^2] at 30 frames per
/// second: what quick everyday movement reaches (a jump's landing is a few times more,
/// for a frame or two, which the measurements then carry).
struct SlotAcceleration {
  Slot slot;
  double sigma;
};
inline constexpr std::array<SlotAcceleration, kSlotCount> kAccelerations{{
    {Slot::kHipsPosition, 10.0},
    {Slot::kHips, 30.0},
    {Slot::kAbdomenEnd, 30.0},
    {Slot::kThorax, 30.0},
    {Slot::kNeck, 40.0},
    {Slot::kHead, 50.0},
    {Slot::kLeftShoulder, 30.0},
    {Slot::kRightShoulder, 30.0},
    {Slot::kLeftArm, 70.0},
    {Slot::kRightArm, 70.0},
    {Slot::kLeftLeg, 60.0},
    {Slot::kRightLeg, 60.0},
    {Slot::kLeftHand, 110.0},
    {Slot::kRightHand, 110.0},
    {Slot::kLeftFoot, 90.0},
    {Slot::kRightFoot, 90.0},
    {Slot::kLeftElbow, 80.0},
    {Slot::kRightElbow, 80.0},
    {Slot::kLeftKnee, 80.0},
    {Slot::kRightKnee, 80.0},
    {Slot::kLeftForearmTwist, 60.0},
    {Slot::kRightForearmTwist, 60.0},
    {Slot::kLeftShankTwist, 30.0},
    {Slot::kRightShankTwist, 30.0},
    {Slot::kLeftUpperArmTwist, 40.0},
    {Slot::kRightUpperArmTwist, 40.0},
    {Slot::kLeftThighTwist, 30.0},
    {Slot::kRightThighTwist, 30.0},
}};

/// The speed of a slot from frame to frame: an Ornstein-Uhlenbeck process.
struct StepProcess {
  double sigma;  ///< Of the change of a step from one frame to the next.
  double keeps;  ///< Share of a step that the next one inherits.
};

[[nodiscard]] inline StepProcess process_of(const SlotAcceleration& row, FrameRate rate) {
  const double dt = 1.0 / rate.hz;
  const double memory_s = row.slot == Slot::kHipsPosition ? 1.0 : 0.25;
  // Variance of a second difference of integrated white noise grows with the cube of dt.
  return {row.sigma * std::sqrt(dt * dt * dt / 30.0), std::exp(-dt / memory_s)};
}

}  // namespace marey::reconstruct
