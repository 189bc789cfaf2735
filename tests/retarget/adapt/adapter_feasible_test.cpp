// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Targets taken from an existing posture are met.
namespace marey::retarget {
namespace {

// Bent, rotated and moved slightly, with the feet where they are in `reference`.
Pose another_posture(const Character& body, const Pose& reference, Dice& dice) {
  Pose pose = reference;
  pose.root_in_world += glm::dvec3(
      dice.between(-0.1, 0.1), dice.between(-0.1, 0.0), dice.between(-0.1, 0.1));
  for (const char* bone : {"spine", "chest", "upperChest"}) {
    pose.parent_from_joint[joint_at(body, bone)] = dice.turn(0.25);
  }
  for (const char* bone : {"leftUpperArm", "rightUpperArm"}) {
    glm::dquat& rotation = pose.parent_from_joint[joint_at(body, bone)];
    rotation = rotation * dice.turn(0.8);
  }
  for (const char* bone : {"leftLowerArm", "rightLowerArm"}) {
    const std::size_t joint = joint_at(body, bone);
    pose.parent_from_joint[joint] =
        glm::angleAxis(dice.between(0.2, 1.5), limb_of(body, joint).hinge_in_upper);
  }
  Constraint left = standing("left", "leftFoot");
  Constraint right = standing("right", "rightFoot");
  left.goal = Support{place_of(body, reference, {"leftFoot"}),
                      rotation_of(body, reference, "leftFoot"),
                      false};
  right.goal = Support{place_of(body, reference, {"rightFoot"}),
                       rotation_of(body, reference, "rightFoot"),
                       false};
  return adapted(body, {{left, right}, {}}, pose).pose;
}

ConstraintSet feet() {
  return {{standing("left", "leftFoot"), standing("right", "rightFoot")}, {}};
}

class AdapterFeasible : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterFeasible, both_methods(), name_of);
/// Property that the thesis' method does not have.
class AdapterFeasibleStrict : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterFeasibleStrict, strict_method(), name_of);

void expect_reached(const Character& body, const AdaptOptions& options, bool balanced) {
  Dice dice(91);
  const Pose reference = waiting(body);
  int tried = 0;
  int worse = 0;
  double worst_m = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Pose truth = another_posture(body, reference, dice);
    if (beyond_limits_rad(body, truth) > 1e-5) continue;
    ++tried;
    ConstraintSet asked = feet();
    for (const char* point : {"leftHand", "rightHand"}) {
      asked.constraints.push_back(contact(point, point, place_of(body, truth, {point})));
    }
    Adapter adapter = make_adapter(body, asked, options);
    if (balanced) adapter.set_balance_target(centre_of_mass(body, truth));
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));
    double off_m = 0.0;
    for (const char* point : {"leftHand", "rightHand", "leftFoot", "rightFoot"}) {
      const Pose& from = std::string(point).ends_with("Foot") ? reference : truth;
      off_m = std::max(
          off_m,
          glm::distance(place_of(body, out, {point}), place_of(body, from, {point})));
    }
    if (balanced) {
      glm::dvec3 off = centre_of_mass(body, out) - centre_of_mass(body, truth);
      if (options.balance == BalanceMode::kHorizontal) off.y = 0.0;
      off_m = std::max(off_m, glm::length(off));
    }
    worst_m = std::max(worst_m, off_m);
    if (off_m > 1e-3 + 1e-5) ++worse;
  }
  EXPECT_EQ(worse, 0) << "of " << tried << "; the worst by " << worst_m << " m";
  EXPECT_GT(tried, 100) << "of 200: the limits leave too few postures for this test";
}

TEST_P(AdapterFeasible, ReachesWithBothHandsOnBothFeet) {
  expect_reached(human(false), options(), false);
}

TEST_P(AdapterFeasible, ReachesWithinLimits) {
  expect_reached(human(true), options(), false);
}

TEST_P(AdapterFeasible, ReachesWhileBalancing) {
  AdaptOptions wanted = options();
  wanted.balance = BalanceMode::kHorizontal;
  expect_reached(human(false), wanted, true);
}

TEST_P(AdapterFeasibleStrict, ReachesWithItsCentreOfMassInPlace) {
  AdaptOptions wanted = options();
  wanted.balance = BalanceMode::k3d;
  expect_reached(human(false), wanted, true);
}

// The body has no supports: it can be anywhere.
TEST_P(AdapterFeasible, ReachesAnythingWhenItStandsOnNothing) {
  for (const Character& body : bodies()) {
    const std::string end = body.skeleton.joints.back().name;
    Dice dice(92);
    for (int i = 0; i < 100; ++i) {
      const Pose reference = random_posture(body, dice, 0.4);
      const glm::dvec3 target =
          place_of(body, reference, {end}) + dice.between(0, 3) * dice.direction();
      const Adapted out =
          adapted(body, {{contact("end", end, target)}, {}}, reference, options());
      ASSERT_LT(glm::distance(place_of(body, out.pose, {end}), target), 1e-3 + 1e-5) << i;
    }
  }
}

}  // namespace
}  // namespace marey::retarget
