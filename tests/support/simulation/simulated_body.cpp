// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/human/average_proportions.h"

namespace marey::testing {
namespace {

using B = HumanBone;

/// Spread of a length beyond stature's share, standard deviation over mean. The values
/// are close to the spread of the ratios of segment lengths to stature in surveys (ANSUR:
/// 3 to 6 %). Parts that are small or cannot be measured from outside spread more.
constexpr double kLimbSpread = 0.045;
constexpr double kTrunkSpread = 0.06;
constexpr double kWidthSpread = 0.07;
constexpr double kSideDifference_m = 0.003;

double side_of(std::size_t limb) {
  return limb % 2 == 0 ? 1.0 : -1.0;
}

/// 1 + a spread, never beyond two and a half standard deviations.
double factor(Dice& dice, double spread) {
  return 1.0 + std::clamp(dice.noise(spread), -2.5 * spread, 2.5 * spread);
}

glm::dvec3 mirrored_in_x(const glm::dvec3& v) {
  return {-v.x, v.y, v.z};
}

Proportions draw_proportions(Dice& dice, double stature_m) {
  Proportions p = average_proportions(stature_m);
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest}) {
    p[bone] *= factor(dice, kTrunkSpread);
    p[bone].z += dice.noise(0.006);
  }
  p[B::kNeck] *= factor(dice, kTrunkSpread);
  p[B::kNeck].z += dice.noise(0.008) - 0.008;
  p[B::kHead] *= factor(dice, 0.10);
  p[B::kHead].z += dice.noise(0.006) + 0.01;
  p[B::kLeftShoulder] += glm::dvec3(
      std::abs(dice.noise(0.008)), dice.noise(0.012), dice.noise(0.012) + 0.01);
  p[B::kLeftUpperArm] *= factor(dice, kWidthSpread);
  // Collar bones slope backward.
  p[B::kLeftUpperArm].z -= 0.02 + dice.noise(0.01);
  p[B::kLeftUpperArm].y += dice.noise(0.008);
  p[B::kLeftLowerArm] *= factor(dice, kLimbSpread);
  p[B::kLeftHand] *= factor(dice, kLimbSpread);
  p[B::kLeftUpperLeg].x *= factor(dice, kWidthSpread);
  p[B::kLeftUpperLeg].y += dice.noise(0.008);
  p[B::kLeftUpperLeg].z += dice.noise(0.010);
  p[B::kLeftLowerLeg] *= factor(dice, kLimbSpread);
  p[B::kLeftFoot] *= factor(dice, kLimbSpread);
  p[B::kLeftToes].z *= factor(dice, kLimbSpread);
  p.left_hand_tip_in_hand *= factor(dice, kLimbSpread);
  for (const B bone : human_bones()) {
    if (index(mirrored(bone)) <= index(bone)) continue;
    const double length_m = glm::length(p[bone]);
    const double other = std::clamp(dice.noise(kSideDifference_m), -0.009, 0.009);
    p[mirrored(bone)] = mirrored_in_x(p[bone]) * (1.0 + other / length_m);
  }
  p.right_hand_tip_in_hand = mirrored_in_x(p.left_hand_tip_in_hand);
  return p;
}

double standing_height_m(const Proportions& p) {
  double height_m = p.head_top_in_head.y;
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck, B::kHead}) {
    height_m += p[bone].y;
  }
  height_m -= p[B::kLeftUpperLeg].y + p[B::kLeftLowerLeg].y + p[B::kLeftFoot].y;
  return height_m - p[B::kLeftToes].y + 0.012 * height_m;
}

glm::dquat about(const glm::dvec3& vector_rad) {
  return rotation_from_vector(vector_rad);
}

SimulatedBody::Hinge draw_hinge(Dice& dice, std::size_t limb) {
  SimulatedBody::Hinge hinge;
  const double side = side_of(limb);
  const glm::dvec3 askew(dice.noise(0.05), dice.noise(0.05), dice.noise(0.05));
  hinge.axis = about(askew) * human_limbs()[limb].hinge_axis;
  const double valgus = limb < 2 ? 0.15 + dice.noise(0.05) : 0.05 + dice.noise(0.03);
  hinge.carry = about({0.0, 0.0, side * valgus});
  hinge.rollback_m = limb < 2 ? 0.0 : dice.between(0.0, 0.006);
  return hinge;
}

/// The rotations of all joints in their parents, feet as if in the air.
std::array<glm::dquat, kHumanBoneCount> joint_rotations(const SimulatedBody& body,
                                                        const Attitude& a) {
  std::array<glm::dquat, kHumanBoneCount> turn;
  turn.fill(glm::dquat(1, 0, 0, 0));
  const auto at = [&](Angle angle) { return a[index(angle)]; };
  turn[index(B::kHips)] = about({0, at(Angle::kHeading), 0}) *
                          about({at(Angle::kHipsTilt), 0, at(Angle::kHipsList)});
  const glm::dvec3 trunk(at(Angle::kTrunkX), at(Angle::kTrunkY), at(Angle::kTrunkZ));
  turn[index(B::kSpine)] = about(body.spine_shares[0] * trunk);
  turn[index(B::kChest)] = about(body.spine_shares[1] * trunk);
  turn[index(B::kUpperChest)] = about(body.spine_shares[2] * trunk);
  const glm::dvec3 head(at(Angle::kHeadX), at(Angle::kHeadY), at(Angle::kHeadZ));
  turn[index(B::kNeck)] = about(body.neck_share * head);
  turn[index(B::kHead)] = about((1.0 - body.neck_share) * head);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const double side = side_of(limb);
    const auto of = [&](LimbAngle angle) { return a[limb_angle(limb, angle)]; };
    const bool is_arm = limb < 2;
    const double spin = of(LimbAngle::kSpin);
    glm::dquat upper = about({-of(LimbAngle::kSwing), 0, 0}) *
                       about({0,
                              0,
                              side * (of(LimbAngle::kRaise) -
                                      (is_arm ? 0.5 * std::numbers::pi : 0.0))}) *
                       (is_arm ? about({spin, 0, 0}) : about({0, side * spin, 0}));
    if (is_arm) {
      const glm::dvec3 arm = upper * glm::dvec3(side, 0, 0);
      const double elevation = std::acos(std::clamp(-arm.y, -1.0, 1.0));
      const glm::dquat clavicle =
          about(
              {0, 0, side * body.clavicle_raise * (elevation - 0.5 * std::numbers::pi)}) *
          about({0, -side * body.clavicle_forward * arm.z, 0});
      turn[index(*parent(bones.upper))] = clavicle;
      upper = glm::conjugate(clavicle) * upper;
    }
    turn[index(bones.upper)] = upper;
    const SimulatedBody::Hinge& hinge = body.hinges[limb];
    const double twist = of(LimbAngle::kTwist);
    turn[index(bones.lower)] =
        about(of(LimbAngle::kBend) * hinge.axis) * hinge.carry *
        (is_arm ? about({twist, 0, 0}) : about({0, side * twist, 0}));
    const double flexion = of(LimbAngle::kEndFlexion);
    const double deviation = of(LimbAngle::kEndDeviation);
    turn[index(bones.end)] = is_arm ? about({0, side * deviation, -side * flexion})
                                    : about({-flexion, side * deviation, 0});
  }
  return turn;
}

/// Returns the shift of a bone's origin from its place with a rigid joint, in its
/// parent's frame.
glm::dvec3 joint_shift(const SimulatedBody& body, const Attitude& a, B bone) {
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const double raised = a[limb_angle(limb, LimbAngle::kRaise)];
    if (limb < 2 && bone == bones.upper) {
      return {0.0, body.shoulder_glide_m * std::sin(std::clamp(raised, 0.0, 1.6)), 0.0};
    }
    if (limb >= 2 && bone == bones.lower) {
      const double bend = a[limb_angle(limb, LimbAngle::kBend)];
      return {0.0, 0.0, -body.hinges[limb].rollback_m * (1.0 - std::cos(bend))};
    }
  }
  return glm::dvec3(0.0);
}

/// Height of the lowest point of a sole.
double sole_m(const SimulatedBody& body, const RigidTransform& foot) {
  const double under_m = -0.039 * body.stature_m;
  const glm::dvec3 heel(0.0, under_m, -0.03 * body.stature_m);
  const glm::dvec3 toe(0.0, under_m, 0.12 * body.stature_m);
  return std::min((foot * heel).y, (foot * toe).y);
}

/// 1 at or below `from`, 0 at or above `to`, smooth between.
double falling(double value, double from, double to) {
  const double s = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return 1.0 - s * s * (3.0 - 2.0 * s);
}

void set_foot_down(const SimulatedBody& body,
                   BoneFrames& frames,
                   B foot,
                   B toes,
                   double height_over_lower_m) {
  const glm::dquat free = frames[index(foot)].rotation;
  const glm::dvec3 forward = free * glm::dvec3(0, 0, 1);
  const glm::dquat flat = about({0, std::atan2(forward.x, forward.z), 0});
  const double planted = falling(height_over_lower_m, 0.01, 0.12);
  frames[index(foot)].rotation = glm::normalize(glm::slerp(free, flat, planted));
  frames[index(toes)] = {frames[index(foot)].rotation,
                         frames[index(foot)] * body.proportions[toes]};
}

}  // namespace

SimulatedBody draw_body(Dice& dice) {
  SimulatedBody body;
  const double wanted_m = dice.between(1.45, 2.0);
  body.proportions = draw_proportions(dice, wanted_m);
  const double to_wanted = wanted_m / standing_height_m(body.proportions);
  for (glm::dvec3& offset : body.proportions.offset_in_parent) offset *= to_wanted;
  body.stature_m = wanted_m;
  body.declared_stature_m = wanted_m + dice.between(-0.02, 0.02);
  body.build = dice.between(0.85, 1.3);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    body.hinges[limb] = draw_hinge(dice, limb);
  }
  // Lumbar vertebrae bend, thoracic ones twist.
  const std::array<glm::dvec3, 3> usual{glm::dvec3(0.45, 0.15, 0.4),
                                        glm::dvec3(0.3, 0.35, 0.3),
                                        glm::dvec3(0.25, 0.5, 0.3)};
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    body.spine_shares[i] = usual[i] * factor(dice, 0.2);
    sum += body.spine_shares[i];
  }
  for (glm::dvec3& share : body.spine_shares) share /= sum;
  body.neck_share = dice.between(0.35, 0.6);
  body.clavicle_raise = dice.between(0.1, 0.3);
  body.clavicle_forward = dice.between(0.0, 0.2);
  body.shoulder_glide_m = dice.between(0.0, 0.006);
  return body;
}

BoneFrames place(const SimulatedBody& body, const Attitude& attitude) {
  const auto turn = joint_rotations(body, attitude);
  BoneFrames frames;
  for (const B bone : human_bones()) {
    const auto up = parent(bone);
    if (!up) {
      frames[index(bone)] = {
          turn[index(bone)],
          {attitude[index(Angle::kFloorX)], 0.0, attitude[index(Angle::kFloorZ)]}};
      continue;
    }
    const glm::dvec3 offset = body.proportions[bone] + joint_shift(body, attitude, bone);
    frames[index(bone)] = frames[index(*up)] * RigidTransform{turn[index(bone)], offset};
  }
  const double left_m = frames[index(B::kLeftFoot)].translation.y;
  const double right_m = frames[index(B::kRightFoot)].translation.y;
  const double lower_m = std::min(left_m, right_m);
  set_foot_down(body, frames, B::kLeftFoot, B::kLeftToes, left_m - lower_m);
  set_foot_down(body, frames, B::kRightFoot, B::kRightToes, right_m - lower_m);
  // A smooth minimum: the root is not to jerk when the other foot takes over.
  constexpr double kSoft_m = 0.01;
  const double left_sole_m = sole_m(body, frames[index(B::kLeftFoot)]);
  const double right_sole_m = sole_m(body, frames[index(B::kRightFoot)]);
  const double apart_m = std::abs(left_sole_m - right_sole_m);
  const double lift_m = -std::min(left_sole_m, right_sole_m) +
                        kSoft_m * std::log1p(std::exp(-apart_m / kSoft_m));
  for (RigidTransform& frame : frames) frame.translation.y += lift_m;
  return frames;
}

glm::dvec3 end_of(B bone, const Proportions& p) {
  switch (bone) {
    case B::kHead:
      return p.head_top_in_head;
    case B::kLeftHand:
      return p.left_hand_tip_in_hand;
    case B::kRightHand:
      return p.right_hand_tip_in_hand;
    case B::kHips:
      return p[B::kSpine];
    case B::kUpperChest:
      return p[B::kNeck];
    default:
      break;
  }
  for (const B child : human_bones()) {
    if (parent(child) == bone) return p[child];
  }
  return glm::dvec3(0.0);
}

}  // namespace marey::testing
