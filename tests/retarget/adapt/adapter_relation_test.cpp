// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Distances between points of the body, and orientations of segments.
namespace marey::retarget {
namespace {

struct Pair {
  const char* one;
  const char* other;
  double min_m;
  double max_m;
};
// Distances that arms, trunk and legs reach easily, also within their limits.
constexpr std::array<Pair, 5> kPairs{{{"leftHand", "rightHand", 0.05, 0.8},
                                      {"leftHand", "head", 0.25, 0.5},
                                      {"leftHand", "rightLowerArm", 0.1, 0.5},
                                      {"leftHand", "hips", 0.2, 0.4},
                                      {"rightHand", "rightFoot", 0.45, 0.9}}};

class AdapterRelations : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterRelations, both_methods(), name_of);
/// Property that the thesis' method does not have.
class AdapterRelationsStrict : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterRelationsStrict, strict_method(), name_of);

TEST_P(AdapterRelationsStrict, KeepADistanceToAnotherConstraint) {
  const Character body = human(false);
  for (const Pair& pair : kPairs) {
    Dice dice(42);
    for (int i = 0; i < 60; ++i) {
      const Pose reference = i % 2 == 0 ? waiting(body) : random_posture(body, dice, 0.3);
      const double distance_m = dice.between(pair.min_m, pair.max_m);
      const glm::dvec3 target =
          place_of(body, reference, {pair.other}) + 0.1 * dice.direction();
      Constraint wish = contact("wish", pair.one, {});
      wish.goal = DistanceToConstraint{distance_m, "other"};
      const Adapted out = adapted(
          body, {{wish, contact("other", pair.other, target)}, {}}, reference, options());
      const glm::dvec3 other = place_of(body, out.pose, {pair.other});
      ASSERT_NEAR(glm::distance(place_of(body, out.pose, {pair.one}), other),
                  distance_m,
                  wish.precision_m + 1e-5)
          << pair.one << " " << pair.other << " " << i;
      ASSERT_LT(glm::distance(other, target), wish.precision_m + 1e-5);
    }
  }
}

TEST_P(AdapterRelations, KeepADistanceToAPoint) {
  const Character body = human(true);
  Dice dice(43);
  for (int i = 0; i < 200; ++i) {
    const Pose reference = random_posture(body, dice, 0.3);
    const glm::dvec3 centre =
        place_of(body, reference, {"rightHand"}) + 0.4 * dice.direction();
    Constraint wish = contact("wish", "rightHand", {});
    const double distance_m = dice.between(0.0, 0.6);
    wish.goal = DistanceToPoint{distance_m, centre};
    const Adapted out = adapted(body, {{wish}, {}}, reference, options());
    ASSERT_NEAR(glm::distance(place_of(body, out.pose, {"rightHand"}), centre),
                distance_m,
                wish.precision_m + 1e-5)
        << i;
  }
}

TEST_P(AdapterRelations, RotateSegmentsToTheirTargets) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    for (const Control control : {Control::kPriority, Control::kBlend}) {
      AdaptOptions wanted = options();
      wanted.control = control;
      for (const char* segment :
           {"leftHand", "rightFoot", "head", "chest", "leftLowerArm", "hips"}) {
        const std::string name(segment);
        const bool extremity = name == "leftHand" || name == "rightFoot";
        Dice dice(44);
        for (int i = 0; i < 40; ++i) {
          const Pose reference = random_posture(body, dice, 0.3);
          Constraint wish;
          wish.id = "turned";
          wish.point.segment = segment;
          const glm::dquat turned =
              dice.turn(0.4) * rotation_of(body, reference, segment);
          wish.goal = SegmentOrientation{turned};
          ConstraintSet asked{{wish}, {}};
          if (i % 2 == 1) {
            asked.constraints.push_back(contact(
                "hand",
                "rightHand",
                place_of(body, reference, {"rightHand"}) + 0.1 * dice.direction()));
          }
          const Adapted out = adapted(body, asked, reference, wanted);
          const double off_rad =
              angle_between_rad(rotation_of(body, out.pose, segment), turned);
          // A precision of 1 mm is met on a lever of a leg's length, 0.86 m.
          ASSERT_LT(off_rad, extremity ? 1e-5 : 1.2e-3) << segment << " " << i;
        }
      }
    }
  }
}

// The first as if it were alone, and the second as near as a rotation about the first
// permits.
void expect_first_exact_second_near(const Character& body, const AdaptOptions& options) {
  Dice dice(45);
  for (int i = 0; i < 100; ++i) {
    const Pose reference = random_posture(body, dice, 0.3);
    const glm::dvec3 shoulder = place_of(body, reference, {"leftUpperArm"});
    const glm::dvec3 hand = place_of(body, reference, {"leftHand"});
    const glm::dvec3 target =
        shoulder + dice.between(0.3, 0.48) *
                       glm::normalize(hand - shoulder + 0.3 * dice.direction());
    const glm::dvec3 elbow_target =
        place_of(body, reference, {"leftLowerArm"}) + 0.15 * dice.direction();
    Constraint first = contact("hand", "leftHand", target, {}, 2.0);
    Constraint second =
        contact("elbow", "leftLowerArm", elbow_target, {0.0, 0.0, 0.03}, 1.0);
    first.range = 3;
    second.range = 2;
    const Adapted alone = adapted(body, {{first}, {}}, reference, options);
    const Adapted both = adapted(body, {{first, second}, {}}, reference, options);
    const auto off = [&](const Adapted& out) {
      return glm::distance(place_of(body, out.pose, first.point), target);
    };
    // Spun by hundreds of rounded products about a line that is 0.3 m long.
    ASSERT_LT(off(both), off(alone) + 1e-5) << i;
    const glm::dvec3 axis =
        glm::normalize(place_of(body, both.pose, {"leftHand"}) - shoulder);
    const glm::dvec3 elbow = place_of(body, both.pose, second.point) - shoulder;
    double best_m = 1e9;
    for (int step = -314; step <= 314; ++step) {
      const double spin_rad = 0.01 * step;
      Pose spun = both.pose;
      const std::size_t upper = joint_at(body, "leftUpperArm");
      const glm::dquat parent = rotation_of(body, both.pose, "leftShoulder");
      spun.parent_from_joint[upper] = glm::conjugate(parent) *
                                      glm::angleAxis(spin_rad, axis) * parent *
                                      both.pose.parent_from_joint[upper];
      if (beyond_limits_rad(body, spun) > 1e-6) continue;
      best_m = std::min(
          best_m,
          glm::distance(shoulder + glm::angleAxis(spin_rad, axis) * elbow, elbow_target));
    }
    ASSERT_LT(glm::distance(shoulder + elbow, elbow_target), best_m + 1e-4) << i;
  }
}

TEST_P(AdapterRelations, MeetTheFirstOfTwoOnALimbAndApproachTheSecond) {
  expect_first_exact_second_near(human(false), options());
}

TEST_P(AdapterRelationsStrict, ReduceBothErrorsOfTwoBlendedOnALimb) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    AdaptOptions blended = options();
    blended.control = Control::kBlend;
    Dice dice(46);
    double could_gain_m = 0.0;
    double gained_m = 0.0;
    for (int i = 0; i < 100; ++i) {
      const Pose reference = random_posture(body, dice, 0.3);
      const auto near = [&](const char* segment) {
        return place_of(body, reference, {segment}) + 0.12 * dice.direction();
      };
      Constraint hand = contact("hand", "leftHand", near("leftHand"), {}, 2.0);
      Constraint elbow =
          contact("elbow", "leftLowerArm", near("leftLowerArm"), {0.0, 0.0, 0.03}, 1.0);
      hand.range = 3;
      elbow.range = 2;
      const auto off = [&](const Adapted& out, const Constraint& wish) {
        return glm::distance(place_of(body, out.pose, wish.point),
                             std::get<DistanceToPoint>(wish.goal).p_in_world);
      };
      const Adapted only_hand = adapted(body, {{hand}, {}}, reference, blended);
      const Adapted only_elbow = adapted(body, {{elbow}, {}}, reference, blended);
      const Adapted both = adapted(body, {{hand, elbow}, {}}, reference, blended);
      // Up to the difference between a mean of rotations and its chord.
      ASSERT_LT(off(both, hand), off(only_elbow, hand) + 0.002) << i;
      ASSERT_LT(off(both, elbow), off(only_hand, elbow)) << i;
      could_gain_m += off(only_hand, elbow) - off(only_elbow, elbow);
      gained_m += off(only_hand, elbow) - off(both, elbow);
    }
    // By its weight: one to two.
    EXPECT_GT(gained_m, could_gain_m / 3.0);
  }
}

}  // namespace
}  // namespace marey::retarget
