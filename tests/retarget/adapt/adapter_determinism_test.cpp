// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"
#include "tests/support/program/count_allocations.h"

/// The same inputs give the same result, independent of earlier postures.
namespace marey::retarget {
namespace {

constexpr double kLater_s = 10.0;

ConstraintSet many_wishes(const Character& body, const Pose& reference) {
  const auto near = [&](const char* segment, const glm::dvec3& by, double importance) {
    return contact(
        segment, segment, place_of(body, reference, {segment}) + by, {}, importance);
  };
  Constraint fading = near("head", {0.1, 0.0, 0.1}, 1.0);
  fading.activation.start_s = kLater_s - 0.3;
  fading.activation.start_duration_s = 1.0;
  return {{standing("left", "leftFoot"),
           near("leftHand", {0.2, 0.5, 0.4}, 3.0),
           near("rightHand", {-0.1, 0.1, 0.2}, 2.0),
           fading},
          {}};
}

class AdapterDeterminism : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterDeterminism, both_methods(), name_of);

TEST_P(AdapterDeterminism, GivesTheSameBitsForTheSameQuestion) {
  const Character body = human(true);
  const Pose reference = waiting(body);
  for (const Control control : {Control::kPriority, Control::kBlend}) {
    AdaptOptions wanted = options();
    wanted.control = control;
    wanted.balance = BalanceMode::kHorizontal;
    const ConstraintSet wishes = many_wishes(body, reference);
    Adapter one = make_adapter(body, wishes, wanted);
    Adapter other = make_adapter(body, wishes, wanted);
    Pose first;
    Pose second;
    static_cast<void>(one.adapt(reference, kLater_s, first));
    static_cast<void>(other.adapt(reference, kLater_s, second));
    EXPECT_TRUE(same_bits(first, second));
    static_cast<void>(one.adapt(reference, kLater_s, second));
    EXPECT_TRUE(same_bits(first, second));
  }
}

TEST_P(AdapterDeterminism, DoesNotDependOnPreviousRequests) {
  const Character body = human(true);
  Dice dice(8);
  const Pose reference = random_posture(body, dice, 0.4);
  const ConstraintSet wishes = many_wishes(body, reference);
  for (const BalanceMode balance : {BalanceMode::kOff, BalanceMode::k3d}) {
    AdaptOptions wanted = options();
    wanted.balance = balance;
    Adapter adapter = make_adapter(body, wishes, wanted);
    // The support begins here and keeps this position from now on.
    Pose first;
    static_cast<void>(adapter.adapt(reference, kLater_s, first));
    const glm::dvec3 target =
        std::get<DistanceToPoint>(wishes.find("leftHand")->goal).p_in_world;
    Pose out;
    for (int i = 0; i < 20; ++i) {
      adapter.constraint("leftHand")->set_target(target + 2.0 * dice.direction());
      AdaptOptions others = wanted;
      others.control = Control::kBlend;
      others.max_iterations = 1 + i;
      adapter.set_options(others);
      static_cast<void>(
          adapter.adapt(random_posture(body, dice, 0.5), 10.0 + 0.1 * i, out));
      adapter.constraint("leftHand")->set_target(target);
      adapter.set_options(wanted);
      static_cast<void>(adapter.adapt(reference, kLater_s, out));
      ASSERT_TRUE(same_bits(first, out)) << i;
    }
  }
}

// A section rotates as a whole, even where only its first vertebra has a target.
TEST_P(AdapterDeterminism, DoesNotDependOnPreviousRequestsForPartOfASection) {
  const Character body = bodies().back();
  Dice dice(10);
  for (const char* segment : {"tail1", "tail3", "neck1", "back2", "head"}) {
    const Pose reference = random_posture(body, dice, 0.4);
    const glm::dvec3 offset(0.0, 0.03, 0.08);
    const glm::dvec3 target =
        place_of(body, reference, {segment, offset}) + 0.1 * dice.direction();
    const ConstraintSet wishes{{contact("wish", segment, target, offset)}, {}};
    Adapter adapter = make_adapter(body, wishes, options());
    Pose first;
    static_cast<void>(adapter.adapt(reference, kLater_s, first));
    Pose out;
    for (int i = 0; i < 10; ++i) {
      static_cast<void>(adapter.adapt(random_posture(body, dice, 0.5), kLater_s, out));
      static_cast<void>(adapter.adapt(reference, kLater_s, out));
      ASSERT_TRUE(same_bits(first, out)) << segment << " " << i;
    }
  }
}

TEST_P(AdapterDeterminism, AllocatesNothingAfterTheFirstPosture) {
  for (const Character& body : bodies()) {
    const std::string end = body.skeleton.joints.back().name;
    Dice dice(9);
    Constraint fading = contact("fading", end, {0.3, 1.0, 0.2});
    fading.activation.start_s = 0.0;
    fading.activation.start_duration_s = 0.5;
    AdaptOptions wanted = options();
    wanted.balance = BalanceMode::kHorizontal;
    Adapter adapter =
        make_adapter(body, {{fading, contact("end", end, {}, {}, 2.0)}, {}}, wanted);
    const Pose reference = random_posture(body, dice, 0.4);
    auto handle = *adapter.constraint("end");
    Pose out;
    static_cast<void>(adapter.adapt(reference, 0.0, out));

    const long before = testing::allocations();
    for (int i = 0; i < 100; ++i) {
      handle.set_target({0.3, 0.01 * i, 0.5});
      static_cast<void>(adapter.adapt(reference, 0.01 * i, out));
    }
    EXPECT_EQ(testing::allocations() - before, 0);
  }
}

}  // namespace
}  // namespace marey::retarget
