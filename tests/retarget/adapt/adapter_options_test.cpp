// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Ranges, thresholds, and changes by handles.
namespace marey::retarget {
namespace {

class AdapterOptions : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterOptions, both_methods(), name_of);

glm::dvec3 far_from(const Character& body, const Pose& pose, const char* point) {
  return place_of(body, pose, {point}) + glm::dvec3(0.3, 0.5, 0.6);
}

TEST_P(AdapterOptions, TheRootStaysWhenItIsNotToTravel) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  AdaptOptions wanted = options();
  wanted.root_for_constraints = 0.0;
  const Adapted out =
      adapted(body,
              {{contact("hand", "leftHand", far_from(body, reference, "leftHand"))}, {}},
              reference,
              wanted);
  EXPECT_LT(glm::distance(out.pose.root_in_world, reference.root_in_world), 1e-6);
}

// Hand, forearm and upper arm are 3; the clavicle is next.
TEST_P(AdapterOptions, OnlyThoseInRangeMove) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    Dice dice(101);
    for (int i = 0; i < 50; ++i) {
      const Pose reference = random_posture(body, dice, 0.4);
      for (const int range : {1, 2, 3, 4}) {
        Constraint hand = contact("hand",
                                  "leftHand",
                                  place_of(body, reference, {"leftHand"}) +
                                      dice.between(0, 1) * dice.direction(),
                                  {0.1, 0.0, 0.0});
        hand.range = range;
        const Adapted out = adapted(body, {{hand}, {}}, reference, options());
        const auto last = joint_at(body, "leftHand");
        for (std::size_t j = 0; j < body.skeleton.joints.size(); ++j) {
          const bool may_turn = j <= last && j + static_cast<std::size_t>(range) > last;
          if (may_turn) continue;
          ASSERT_LT(angle_between_rad(out.pose.parent_from_joint[j],
                                      reference.parent_from_joint[j]),
                    1e-5)
              << body.skeleton.joints[j].name << " of " << range;
        }
        ASSERT_LT(glm::distance(out.pose.root_in_world, reference.root_in_world), 1e-6);
      }
    }
  }
}

TEST_P(AdapterOptions, ExtremitiesKeepTheirOrientationIfSoWished) {
  const Character body = human(false);
  AdaptOptions wanted = options();
  wanted.extremities_keep_orientation = true;
  Dice dice(102);
  for (int i = 0; i < 50; ++i) {
    const Pose reference = random_posture(body, dice, 0.4);
    const glm::dvec3 target =
        place_of(body, reference, {"leftHand"}) + dice.between(0, 1) * dice.direction();
    const Adapted out =
        adapted(body, {{contact("hand", "leftHand", target)}, {}}, reference, wanted);
    for (const char* end : {"leftHand", "rightHand", "leftFoot", "rightFoot"}) {
      ASSERT_LT(angle_between_rad(rotation_of(body, out.pose, end),
                                  rotation_of(body, reference, end)),
                1e-5)
          << end << " " << i;
    }
  }
}

TEST_P(AdapterOptions, AFixedRootStaysEvenOffBalance) {
  const Character body = human(false);
  AdaptOptions wanted = options();
  wanted.root_for_balance = 0.0;
  wanted.root_for_constraints = 0.0;
  Dice dice(103);
  for (const BalanceMode balance : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
    wanted.balance = balance;
    for (int i = 0; i < 30; ++i) {
      const Pose reference = waiting(body);
      Adapter adapter = make_adapter(
          body,
          {{contact("hand", "leftHand", far_from(body, reference, "leftHand"))}, {}},
          wanted);
      adapter.set_balance_target(centre_of_mass(body, reference) +
                                 0.1 * dice.direction());
      Pose out;
      static_cast<void>(adapter.adapt(reference, 0.0, out));
      ASSERT_LT(glm::distance(out.root_in_world, reference.root_in_world), 1e-6) << i;
    }
  }
}

TEST_P(AdapterOptions, OutcomesAreTrue) {
  const Character body = human(true);
  const Pose reference = waiting(body);
  Constraint hand = contact("hand", "leftHand", far_from(body, reference, "leftHand"));
  Constraint head =
      contact("head", "head", far_from(body, reference, "head"), {0, 0.1, 0});
  Constraint later = contact("later", "rightHand", {});
  later.activation.start_s = 5.0;
  Adapter adapter = make_adapter(
      body, {{standing("foot", "leftFoot"), hand, head, later}, {}}, options());
  Pose out;
  const AdaptReport report = adapter.adapt(reference, 0.0, out);
  double worst_m = 0.0;
  for (const Constraint& c : {hand, head}) {
    const double error_m = glm::distance(place_of(body, out, c.point),
                                         std::get<DistanceToPoint>(c.goal).p_in_world);
    // Single precision, 2 m from the root.
    EXPECT_NEAR(adapter.constraint(c.id)->outcome().error_m, error_m, 2e-6) << c.id;
    EXPECT_EQ(adapter.constraint(c.id)->outcome().activation, 1.0);
    worst_m = std::max(worst_m, error_m);
  }
  EXPECT_NEAR(report.worst_error_m, worst_m, 2e-6);
  EXPECT_EQ(adapter.constraint("later")->outcome().activation, 0.0);
  EXPECT_EQ(adapter.constraint("later")->outcome().error_m, 0.0);
  EXPECT_FALSE(adapter.constraint("nobody").has_value());
}

TEST_P(AdapterOptions, HandlesChangeTheirConstraints) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  const glm::dvec3 here = place_of(body, reference, {"leftHand"});
  Constraint box = contact("box", "rightHand", {});
  box.goal = AllowedSpace{{-5, -5, -5}, {5, 5, 5}};
  Constraint turned = contact("turned", "leftFoot", {});
  turned.goal = SegmentOrientation{};
  Adapter adapter = make_adapter(
      body, {{contact("hand", "leftHand", here), box, turned}, {}}, options());
  const BodyPoint finger{"leftHand", {0.1, 0.0, 0.05}};
  const glm::dvec3 target = here + glm::dvec3(0.05, 0.1, 0.1);
  adapter.constraint("hand")->set_offset(finger.offset_in_t_pose);
  adapter.constraint("hand")->set_target(target);
  const glm::dvec3 low = place_of(body, reference, {"rightHand"}) + glm::dvec3(0, 0.1, 0);
  adapter.constraint("box")->set_space(low, low + 0.3);
  const glm::dquat tilted = glm::angleAxis(0.3, glm::dvec3(1, 0, 0));
  adapter.constraint("turned")->set_orientation(tilted);
  Pose out;
  static_cast<void>(adapter.adapt(reference, 0.0, out));
  EXPECT_LT(glm::distance(place_of(body, out, finger), target), 1e-3);
  EXPECT_GT(place_of(body, out, {"rightHand"}).y, low.y - 1e-3);
  EXPECT_LT(angle_between_rad(rotation_of(body, out, "leftFoot"), tilted), 1e-5);
}

TEST_P(AdapterOptions, OptionsOutOfRangeAreRefused) {
  const Character body = human(false);
  AdaptOptions wrong = options();
  wrong.root_for_balance = 1.1;
  EXPECT_FALSE(Adapter::make(body, {}, wrong));
  wrong = options();
  wrong.max_iterations = 0;
  EXPECT_FALSE(Adapter::make(body, {}, wrong));
  wrong = options();
  wrong.balance_precision_m = -1.0;
  EXPECT_FALSE(Adapter::make(body, {}, wrong));
}

}  // namespace
}  // namespace marey::retarget
