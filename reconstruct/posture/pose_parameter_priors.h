// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the human priors of core/human/posture_priors.h by
// parameters of the posture.

#include <array>

#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/human/posture_priors.h"
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
    {PoseParameter::kHips,
     PoseParameter::kAbdomenEnd,
     PoseParameter::kThorax,
     kAbdomenBendSigma_rad},
    {PoseParameter::kThorax,
     PoseParameter::kNeck,
     PoseParameter::kHead,
     kNeckBendSigma_rad},
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
inline constexpr std::array<RelativePosePrior, 8> kRelativePosePriors = [] {
  using P = PoseParameter;
  const glm::dvec3 none(0.0);
  const glm::dvec3 trunk(kTrunkTurnSigma_rad);
  const glm::dvec3 arm(kArmSigma_rad);
  const glm::dvec3 leg(kLegSigma_rad);
  return std::array<RelativePosePrior, 8>{{
      {P::kHips, P::kThorax, none, trunk},
      {P::kThorax, P::kHead, none, trunk},
      {P::kThorax, P::kLeftShoulder, none, kCollarBoneSigma_rad, true},
      {P::kThorax, P::kRightShoulder, none, kCollarBoneSigma_rad, true},
      {P::kThorax, P::kLeftArm, {0, 0, -kHangingArm_rad}, arm},
      {P::kThorax, P::kRightArm, {0, 0, kHangingArm_rad}, arm},
      {P::kHips, P::kLeftLeg, none, leg},
      {P::kHips, P::kRightLeg, none, leg},
  }};
}();

/// Returns the sigma of hands and feet about the direction of the bone before them. [rad]
[[nodiscard]] constexpr double extremity_sigma_rad(std::size_t limb) {
  return limb < 2 ? kHandSigma_rad : kFootSigma_rad;
}
/// Standard deviations of the twist of skin about its bones, in forearms also of
/// pronation. [rad]
struct TwistPriors {
  double upper_arm = kArmTwistSigma_rad;
  double forearm = kArmTwistSigma_rad;
  double leg = kLegTwistSigma_rad;
};

/// Returns the process of the steps of a pose parameter from frame to frame.
[[nodiscard]] inline StepProcess process_of(PoseParameter parameter, FrameRate rate) {
  using P = PoseParameter;
  switch (parameter) {
    case P::kHipsPosition:
      return hips_step_process(rate);
    case P::kHips:
    case P::kAbdomenEnd:
    case P::kThorax:
    case P::kLeftShoulder:
    case P::kRightShoulder:
      return step_process(kTrunkAcceleration_rad_s2, rate);
    case P::kNeck:
      return step_process(kNeckAcceleration_rad_s2, rate);
    case P::kHead:
      return step_process(kHeadAcceleration_rad_s2, rate);
    case P::kLeftArm:
    case P::kRightArm:
      return step_process(kArmAcceleration_rad_s2, rate);
    case P::kLeftLeg:
    case P::kRightLeg:
      return step_process(kLegAcceleration_rad_s2, rate);
    case P::kLeftHand:
    case P::kRightHand:
      return step_process(kHandAcceleration_rad_s2, rate);
    case P::kLeftFoot:
    case P::kRightFoot:
      return step_process(kFootAcceleration_rad_s2, rate);
    case P::kLeftElbow:
    case P::kRightElbow:
    case P::kLeftKnee:
    case P::kRightKnee:
      return step_process(kFlexionAcceleration_rad_s2, rate);
    case P::kLeftUpperArmTwist:
    case P::kRightUpperArmTwist:
      return step_process(kUpperArmTwistAcceleration_rad_s2, rate);
    case P::kLeftForearmTwist:
    case P::kRightForearmTwist:
      return step_process(kForearmTwistAcceleration_rad_s2, rate);
    case P::kLeftShankTwist:
    case P::kRightShankTwist:
    case P::kLeftThighTwist:
    case P::kRightThighTwist:
      return step_process(kLegTwistAcceleration_rad_s2, rate);
  }
  return {};
}

}  // namespace marey::reconstruct
