// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// A less important target increases the error of a more important one by no more than
/// documented at Control::kPriority.
namespace marey::retarget {
namespace {

constexpr std::array<const char*, 8> kSegments{"leftHand",
                                               "rightHand",
                                               "leftFoot",
                                               "rightFoot",
                                               "head",
                                               "leftLowerArm",
                                               "rightLowerArm",
                                               "chest"};

const char* any_segment(Dice& dice) {
  return kSegments[static_cast<std::size_t>(dice.between(0, 7.999))];
}

struct Question {
  Pose reference;
  ConstraintSet higher;  ///< Feet with supports, then the more important target.
  Constraint lower;
  Constraint lowest;
};

// Within reach or far beyond, on two feet, one or none.
Question any_question(const Character& body, bool waits, Dice& dice) {
  Question out{waits ? waiting(body) : random_posture(body, dice, 0.3), {}, {}, {}};
  const double feet = dice.between(0, 1);
  if (feet < 0.6) out.higher.constraints.push_back(standing("left", "leftFoot"));
  if (feet < 0.4) out.higher.constraints.push_back(standing("right", "rightFoot"));
  const auto wish = [&](const char* id, double far_m, double importance) {
    BodyPoint point{any_segment(dice), glm::dvec3(0.0)};
    if (dice.between(0, 1) < 0.3) point.offset_in_t_pose = 0.1 * dice.direction();
    const double max_m = dice.between(0, 1) < 0.5 ? 0.3 : far_m;
    return contact(
        id,
        point.segment,
        place_of(body, out.reference, point) + dice.between(0, max_m) * dice.direction(),
        point.offset_in_t_pose,
        importance);
  };
  out.higher.constraints.push_back(wish("higher", 1.2, 3.0));
  out.lower = wish("lower", 2.0, 2.0);
  out.lowest = wish("lowest", 1.0, 1.0);
  return out;
}

class AdapterLevels : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterLevels, both_methods(), name_of);
/// Property that the thesis' method does not have.
class AdapterLevelsStrict : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterLevelsStrict, strict_method(), name_of);

TEST_P(AdapterLevels, TheLowerCostsTheHigherAMillimetreAtMostOrThreePercentInBalance) {
  for (const bool with_limits : {false, true}) {
    const Character body = human(with_limits);
    for (const BalanceMode balance :
         {BalanceMode::kOff, BalanceMode::kHorizontal, BalanceMode::k3d}) {
      AdaptOptions wanted = options();
      wanted.balance = balance;
      Dice dice(71);
      for (int i = 0; i < 300; ++i) {
        const Question asked = any_question(body, i % 2 == 1, dice);
        const Constraint& first = asked.higher.constraints.back();
        ConstraintSet set = asked.higher;
        const Pose one = adapted(body, set, asked.reference, wanted).pose;
        set.constraints.push_back(asked.lower);
        const Pose two = adapted(body, set, asked.reference, wanted).pose;
        set.constraints.push_back(asked.lowest);
        const Pose three = adapted(body, set, asked.reference, wanted).pose;
        const auto max_error_m = [&](const Pose& pose, const Constraint& wish) {
          const double alone_m = target_distance_m(body, pose, wish);
          if (alone_m <= wish.precision_m) return wish.precision_m + 1e-3;
          // With balance an additional target changes the order in which masses are
          // summed, and rounding then determines the last step with an improvement.
          const bool rounds = balance != BalanceMode::kOff;
          return alone_m + std::max(1e-3, rounds ? 0.03 * alone_m : 0.0);
        };
        ASSERT_LT(target_distance_m(body, two, first), max_error_m(one, first)) << i;
        ASSERT_LT(target_distance_m(body, three, first), max_error_m(one, first)) << i;
        ASSERT_LT(target_distance_m(body, three, asked.lower),
                  max_error_m(two, asked.lower))
            << i;
      }
    }
  }
}

// The held value of a target is its goal, not the current position of its point.
TEST_P(AdapterLevelsStrict, DistancesAndOrientationsAreHeldAsSuch) {
  const Character body = human(false);
  Dice dice(72);
  for (int i = 0; i < 200; ++i) {
    const Pose reference = waiting(body);
    Constraint apart = contact("apart", "leftHand", {}, {}, 3.0);
    apart.goal = DistanceToBody{dice.between(0.1, 0.5), {"rightHand", {}}};
    Constraint turned = contact("turned", "chest", {}, {}, 2.0);
    turned.goal =
        SegmentOrientation{dice.turn(0.3) * rotation_of(body, reference, "chest")};
    const ConstraintSet higher{
        {standing("left", "leftFoot"), standing("right", "rightFoot"), apart, turned},
        {}};
    ConstraintSet both = higher;
    both.constraints.push_back(
        contact("far",
                "rightHand",
                place_of(body, reference, {"rightHand"}) + 1.5 * dice.direction()));
    const auto distance_off_m = [&](const Pose& pose) {
      const double is_m = glm::distance(place_of(body, pose, {"leftHand"}),
                                        place_of(body, pose, {"rightHand"}));
      return std::abs(is_m - std::get<DistanceToBody>(apart.goal).distance_m);
    };
    const auto turn_off_rad = [&](const Pose& pose) {
      return angle_between_rad(
          rotation_of(body, pose, "chest"),
          std::get<SegmentOrientation>(turned.goal).world_from_t_pose);
    };
    const Pose alone = adapted(body, higher, reference, options()).pose;
    const Pose with = adapted(body, both, reference, options()).pose;
    ASSERT_LT(distance_off_m(with), std::max(distance_off_m(alone), 1e-3) + 1e-3) << i;
    ASSERT_LT(turn_off_rad(with), std::max(turn_off_rad(alone), 1.2e-3) + 1.2e-3) << i;
  }
}

}  // namespace
}  // namespace marey::retarget
