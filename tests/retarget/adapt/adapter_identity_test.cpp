// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// Without targets the posture is unchanged.
namespace marey::retarget {
namespace {

// Single precision rounds positions of a body of 2 m to 1e-7 m, over a dozen joints.
constexpr double kRounding_m = 1e-6;
constexpr double kRounding_rad = 1e-6;
constexpr int kPostures = 100;

class AdapterIdentity : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterIdentity, both_methods(), name_of);

TEST_P(AdapterIdentity, KeepsAPostureWithoutConstraints) {
  for (const Character& body : bodies()) {
    Dice dice(1);
    for (const BalanceMode balance :
         {BalanceMode::kOff, BalanceMode::kHorizontal, BalanceMode::k3d}) {
      AdaptOptions wanted = options();
      wanted.balance = balance;
      Adapter adapter = make_adapter(body, {}, wanted);
      Pose out;
      for (int i = 0; i < kPostures; ++i) {
        const Pose reference = random_posture(body, dice, 0.5);
        static_cast<void>(adapter.adapt(reference, 0.0, out));
        ASSERT_LT(furthest_m(body, out, reference), kRounding_m);
        ASSERT_LT(max_turned_rad(out, reference), kRounding_rad);
      }
    }
  }
}

TEST_P(AdapterIdentity, KeepsAPostureThatMeetsItsConstraints) {
  const Character body = human(true);
  Dice dice(2);
  for (int i = 0; i < kPostures; ++i) {
    const Pose reference = random_posture(body, dice, 0.4);
    const auto here = [&](const char* segment) {
      return contact(segment, segment, place_of(body, reference, {segment}));
    };
    const Adapted out = adapted(body,
                                {{standing("foot", "leftFoot"),
                                  here("leftHand"),
                                  here("rightLowerArm"),
                                  here("head")},
                                 {}},
                                reference,
                                options());
    // Limbs are closed again, on the target in single precision.
    ASSERT_LT(furthest_m(body, out.pose, reference), 5e-6);
    ASSERT_EQ(out.report.iterations, 0);
  }
}

TEST_P(AdapterIdentity, IgnoresConstraintsThatAreNotActive) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Constraint later = contact("later", "leftHand", {1, 1, 1});
  later.activation.start_s = 2.0;
  later.activation.start_duration_s = 1.0;
  Adapter adapter = make_adapter(body, {{later}, {}}, options());
  Pose out;
  static_cast<void>(adapter.adapt(reference, 1.999, out));
  EXPECT_LT(furthest_m(body, out, reference), kRounding_m);
}

// Checks that the reported joint frames are those of the returned pose.
TEST_P(AdapterIdentity, ReportsTheJointFramesOfItsPose) {
  for (const Character& body : bodies()) {
    Dice dice(3);
    const std::string end = body.skeleton.joints.back().name;
    Adapter adapter = make_adapter(body, {{contact("end", end, {})}, {}}, options());
    Pose out;
    for (int i = 0; i < kPostures; ++i) {
      const Pose reference = random_posture(body, dice, 0.5);
      const glm::dvec3 target =
          place_of(body, reference, {end}) + dice.between(0, 1) * dice.direction();
      adapter.constraint("end")->set_target(target);
      const AdaptReport report = adapter.adapt(reference, 0.0, out);
      const auto truth = world_from_joints(body.skeleton, out);
      for (std::size_t j = 0; j < truth.size(); ++j) {
        // As above, over a chain that was also rotated a hundred times.
        ASSERT_LT(glm::distance(adapter.world_from_joint()[j].translation,
                                truth[j].translation),
                  5e-6);
      }
      ASSERT_NEAR(
          report.worst_error_m, glm::distance(truth.back().translation, target), 5e-6);
    }
  }
}

}  // namespace
}  // namespace marey::retarget
