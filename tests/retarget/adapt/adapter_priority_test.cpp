// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Supports have priority over the centre of mass, the centre of mass over constraints,
/// more important constraints over others.
namespace marey::retarget {
namespace {

constexpr double kStands_m = 1e-5;
constexpr double kStands_rad = 1e-5;

class AdapterPriority : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterPriority, both_methods(), name_of);
/// Property that the thesis' method does not have.
class AdapterPriorityStrict : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterPriorityStrict, strict_method(), name_of);

// Targets of hands up to 2 m away: mostly out of reach.
ConstraintSet far_hands(const Character& body, const Pose& reference, Dice& dice) {
  const auto far = [&](const char* hand, double importance) {
    return contact(
        hand,
        hand,
        place_of(body, reference, {hand}) + dice.between(0, 2) * dice.direction(),
        {},
        importance);
  };
  return {{far("leftHand", 2.0), far("rightHand", 1.0)}, {}};
}

struct Feet {
  double off_m = 0.0;
  double turned_rad = 0.0;
};

Feet compare_feet(const Character& body,
                  const Pose& pose,
                  const Pose& reference,
                  std::initializer_list<const char*> feet) {
  Feet out;
  for (const char* foot : feet) {
    out.off_m = std::max(
        out.off_m,
        glm::distance(place_of(body, pose, {foot}), place_of(body, reference, {foot})));
    out.turned_rad = std::max(out.turned_rad,
                              angle_between_rad(rotation_of(body, pose, foot),
                                                rotation_of(body, reference, foot)));
  }
  return out;
}

void expect_feet_to_stand(const Character& body, AdaptOptions options) {
  Dice dice(11);
  for (const BalanceMode balance :
       {BalanceMode::kOff, BalanceMode::kHorizontal, BalanceMode::k3d}) {
    options.balance = balance;
    for (int i = 0; i < 100; ++i) {
      Pose reference = waiting(body);
      reference.parent_from_joint[joint_at(body, "spine")] = dice.turn(0.2);
      ConstraintSet asked = far_hands(body, reference, dice);
      asked.constraints.push_back(standing("left", "leftFoot"));
      asked.constraints.push_back(standing("right", "rightFoot"));
      const Adapted both = adapted(body, asked, reference, options);
      const Feet feet =
          compare_feet(body, both.pose, reference, {"leftFoot", "rightFoot"});
      ASSERT_LT(feet.off_m, kStands_m) << i;
      ASSERT_LT(feet.turned_rad, kStands_rad) << i;

      asked.constraints.pop_back();
      const Pose any = random_posture(body, dice, 0.3);
      const Adapted one = adapted(body, asked, any, options);
      const Feet foot = compare_feet(body, one.pose, any, {"leftFoot"});
      ASSERT_LT(foot.off_m, kStands_m) << i;
      ASSERT_LT(foot.turned_rad, kStands_rad) << i;
    }
  }
}

TEST_P(AdapterPriority, KeepsFeetInPlaceDespiteOtherConstraints) {
  expect_feet_to_stand(human(false), options());
}

TEST_P(AdapterPriority, KeepsFeetInPlaceWithinLimitsDespiteOtherConstraints) {
  expect_feet_to_stand(human(true), options());
}

TEST_P(AdapterPriority, PutsFeetAtTheirTargets) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Dice dice(12);
  for (int i = 0; i < 100; ++i) {
    Constraint left = standing("left", "leftFoot");
    Constraint right = standing("right", "rightFoot");
    const auto near = [&](const char* foot) {
      return place_of(body, reference, {foot}) + 0.15 * dice.direction();
    };
    const glm::dvec3 left_at = near("leftFoot");
    const glm::dvec3 right_at = near("rightFoot");
    left.goal = Support{left_at, std::nullopt, false};
    right.goal = Support{right_at, std::nullopt, false};
    const Adapted out = adapted(body, {{left, right}, {}}, reference, options());
    ASSERT_LT(glm::distance(place_of(body, out.pose, {"leftFoot"}), left_at), kStands_m);
    ASSERT_LT(glm::distance(place_of(body, out.pose, {"rightFoot"}), right_at),
              kStands_m);
  }
}

TEST_P(AdapterPriority, BalancesWheneverItCan) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    const Pose reference = waiting(body);
    for (const BalanceMode balance : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
      AdaptOptions wanted = options();
      wanted.balance = balance;
      const bool in_height = balance == BalanceMode::k3d;
      Adapter adapter = make_adapter(
          body,
          {{standing("left", "leftFoot"), standing("right", "rightFoot")}, {}},
          wanted);
      Dice dice(13);
      Pose out;
      for (int i = 0; i < 200; ++i) {
        const glm::dvec3 target = centre_of_mass(body, reference) +
                                  glm::dvec3(dice.between(-0.12, 0.12),
                                             in_height ? dice.between(-0.15, 0.0) : 0.0,
                                             dice.between(-0.12, 0.12));
        adapter.set_balance_target(target);
        static_cast<void>(adapter.adapt(reference, 0.0, out));
        glm::dvec3 off = centre_of_mass(body, out) - target;
        if (!in_height) off.y = 0.0;
        // Plus single precision.
        ASSERT_LT(glm::length(off), wanted.balance_precision_m + 1e-6) << i;
        const Feet feet = compare_feet(body, out, reference, {"leftFoot", "rightFoot"});
        ASSERT_LT(feet.off_m, kStands_m) << i;
        ASSERT_LT(
            glm::distance(adapter.centre_of_mass_in_world(), centre_of_mass(body, out)),
            2e-6);
      }
    }
  }
}

// The reference itself is balanced on its feet, so balance is always possible.
TEST_P(AdapterPriorityStrict, HandsDoNotCostBalance) {
  const Character body = human(false);
  Dice dice(14);
  for (const BalanceMode balance : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
    AdaptOptions wanted = options();
    wanted.balance = balance;
    for (int i = 0; i < 200; ++i) {
      const Pose reference = waiting(body);
      ConstraintSet asked = far_hands(body, reference, dice);
      asked.constraints.push_back(standing("left", "leftFoot"));
      asked.constraints.push_back(standing("right", "rightFoot"));
      const Adapted out = adapted(body, asked, reference, wanted);
      glm::dvec3 off = centre_of_mass(body, out.pose) - centre_of_mass(body, reference);
      if (balance == BalanceMode::kHorizontal) off.y = 0.0;
      ASSERT_LT(glm::length(off), wanted.balance_precision_m + 1e-6) << i;
    }
  }
}

}  // namespace
}  // namespace marey::retarget
