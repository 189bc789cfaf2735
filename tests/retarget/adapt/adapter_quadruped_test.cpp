// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"
#include "tests/support/bodies/quadruped.h"

/// A quadruped differs from a human in its table of groups only.
namespace marey::retarget {
namespace {

constexpr double kQuadrupedStands_m = 1e-5;
constexpr std::array<const char*, 4> kPaws{
    "front left paw", "front right paw", "hind left paw", "hind right paw"};
BodyPoint nose() {
  return {"head", {0.0, -0.04, 0.2}};
}

class AdapterQuadruped : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterQuadruped, both_methods(), name_of);

TEST_P(AdapterQuadruped, LiftsOnePawAndStandsOnThree) {
  const Character animal = testing::make_quadruped();
  const Pose reference = waiting(animal);
  Dice dice(51);
  for (int i = 0; i < 100; ++i) {
    AdaptOptions wanted = options();
    if (i % 3 == 0) wanted.balance = BalanceMode::kHorizontal;
    const std::string lifted = kPaws[static_cast<std::size_t>(i % 4)];
    const glm::dvec3 target =
        place_of(animal, reference, {lifted}) + glm::dvec3(dice.between(-0.1, 0.1),
                                                           dice.between(0, 0.2),
                                                           dice.between(-0.12, 0.12));
    ConstraintSet asked{{contact("lifted", lifted, target)}, {}};
    for (const char* paw : kPaws) {
      if (paw != lifted) asked.constraints.push_back(standing(paw, paw));
    }
    const Adapted out = adapted(animal, asked, reference, wanted);
    for (const char* paw : kPaws) {
      if (paw == lifted) continue;
      ASSERT_LT(glm::distance(place_of(animal, out.pose, {paw}),
                              place_of(animal, reference, {paw})),
                kQuadrupedStands_m)
          << i;
    }
    ASSERT_LT(glm::distance(place_of(animal, out.pose, {lifted}), target), 1.001e-3) << i;
    ASSERT_LT(beyond_limits_rad(animal, out.pose), 1e-4) << i;
  }
}

// A neck of 0.36 m and a back of 0.5 m permit 15 cm in any direction.
TEST_P(AdapterQuadruped, ReachesNearTargetsWithTheNoseOnFourPaws) {
  const Character animal = testing::make_quadruped();
  const Pose reference = waiting(animal);
  Dice dice(52);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 target =
        place_of(animal, reference, nose()) + dice.between(0, 0.15) * dice.direction();
    ConstraintSet asked{{contact("nose", "head", target, nose().offset_in_t_pose)}, {}};
    for (const char* paw : kPaws) asked.constraints.push_back(standing(paw, paw));
    const Adapted out = adapted(animal, asked, reference, options());
    for (const char* paw : kPaws) {
      ASSERT_LT(glm::distance(place_of(animal, out.pose, {paw}),
                              place_of(animal, reference, {paw})),
                kQuadrupedStands_m)
          << i;
    }
    ASSERT_LT(glm::distance(place_of(animal, out.pose, nose()), target), 1.001e-3) << i;
    ASSERT_LT(beyond_limits_rad(animal, out.pose), 1e-4) << i;
  }
}

TEST_P(AdapterQuadruped, TurnsItsHead) {
  const Character animal = testing::make_quadruped();
  const Pose reference = waiting(animal);
  Dice dice(53);
  for (int i = 0; i < 50; ++i) {
    const glm::dquat turned = dice.turn(0.6) * rotation_of(animal, reference, "head");
    Constraint wish;
    wish.id = "head";
    wish.point.segment = "head";
    wish.goal = SegmentOrientation{turned};
    ConstraintSet asked{{wish}, {}};
    for (const char* paw : kPaws) asked.constraints.push_back(standing(paw, paw));
    const Adapted out = adapted(animal, asked, reference, options());
    // 1 mm on a leg of 0.5 m.
    ASSERT_LT(angle_between_rad(rotation_of(animal, out.pose, "head"), turned), 2.1e-3);
  }
}

}  // namespace
}  // namespace marey::retarget
