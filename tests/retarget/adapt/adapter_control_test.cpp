// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

namespace marey::retarget {
namespace {

/// Two hands whose targets cannot both be met, on a standing trunk.
ConstraintSet torn_apart() {
  return {{contact("right", "rightHand", {-1.6, 1.2, 0.6}, glm::dvec3(0.0), 2.0),
           contact("left", "leftHand", {1.6, 1.3, 0.5}, glm::dvec3(0.0), 1.0),
           standing("foot", "leftFoot")},
          {}};
}

AdaptOptions control_options(Control control, double change_s) {
  AdaptOptions out;
  out.control = control;
  out.control_change_s = change_s;
  return out;
}

TEST(AdapterControl, PassesOverFromPriorityToBlendWithoutAJump) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Adapter changing =
      make_adapter(body, torn_apart(), control_options(Control::kPriority, 0.4));
  Adapter blending =
      make_adapter(body, torn_apart(), control_options(Control::kBlend, 0.4));
  Pose before;
  Pose now;
  Pose goal;
  static_cast<void>(changing.adapt(reference, 0.0, before));
  static_cast<void>(blending.adapt(reference, 0.0, goal));
  // The test requires that the two results are far apart.
  const double whole_way_rad = max_turned_rad(goal, before);
  ASSERT_GT(whole_way_rad, 0.2);
  changing.set_options(control_options(Control::kBlend, 0.4));
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    static_cast<void>(changing.adapt(reference, 0.001 * i, now));
    // The ramp is steepest in its middle, 1.875 times its mean; chords instead of arcs
    // and limbs that close on the mean take at most four times that.
    ASSERT_LT(max_turned_rad(now, before), 4.0 * 1.875 * whole_way_rad / kSteps) << i;
    before = now;
  }
  // Afterwards the result is that of the new control, to the bit.
  static_cast<void>(changing.adapt(reference, 1.0, now));
  for (std::size_t j = 0; j < now.parent_from_joint.size(); ++j) {
    ASSERT_EQ(now.parent_from_joint[j], goal.parent_from_joint[j]) << j;
  }
}

TEST(AdapterControl, ChangesAtOnceWhenNoDurationIsGiven) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Adapter changing =
      make_adapter(body, torn_apart(), control_options(Control::kPriority, 0.0));
  Adapter blending =
      make_adapter(body, torn_apart(), control_options(Control::kBlend, 0.0));
  Pose now;
  Pose goal;
  static_cast<void>(changing.adapt(reference, 0.0, now));
  static_cast<void>(blending.adapt(reference, 0.0, goal));
  changing.set_options(control_options(Control::kBlend, 0.0));
  static_cast<void>(changing.adapt(reference, 0.1, now));
  for (std::size_t j = 0; j < now.parent_from_joint.size(); ++j) {
    ASSERT_EQ(now.parent_from_joint[j], goal.parent_from_joint[j]) << j;
  }
}

// A change that is reverted before any posture has no effect.
TEST(AdapterControl, AChangeThatIsTakenBackAtOnceChangesNothing) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  Adapter changing =
      make_adapter(body, torn_apart(), control_options(Control::kPriority, 0.4));
  Pose goal;
  Pose now;
  static_cast<void>(changing.adapt(reference, 0.0, goal));
  changing.set_options(control_options(Control::kBlend, 0.4));
  changing.set_options(control_options(Control::kPriority, 0.4));
  for (const double time_s : {0.001, 0.2, 1.0}) {
    static_cast<void>(changing.adapt(reference, time_s, now));
    EXPECT_TRUE(same_bits(now, goal)) << time_s;
  }
}

// Back and forth, reverted at every stage, with a change of the duration in between.
TEST(AdapterControl, AChangeThatIsTakenBackOnItsWayTurnsAroundWithoutAJump) {
  const Character body = human(false);
  const Pose reference = waiting(body);
  constexpr double kChange_s = 0.4;
  constexpr double kSlower_s = 0.8;
  constexpr int kSteps = 400;  // 1 ms each: one whole fade.
  Adapter changing =
      make_adapter(body, torn_apart(), control_options(Control::kPriority, kChange_s));
  Adapter blending =
      make_adapter(body, torn_apart(), control_options(Control::kBlend, 0.0));
  Pose before;
  Pose now;
  Pose first;
  Pose goal;
  static_cast<void>(changing.adapt(reference, 0.0, first));
  static_cast<void>(blending.adapt(reference, 0.0, goal));
  const double whole_way_rad = max_turned_rad(goal, first);
  before = first;
  int step = 0;
  const auto go_on = [&](Control control, double change_s, int steps) {
    changing.set_options(control_options(control, change_s));
    for (int i = 0; i < steps; ++i) {
      static_cast<void>(changing.adapt(reference, 0.001 * ++step, now));
      // As above.
      ASSERT_LT(max_turned_rad(now, before), 4.0 * 1.875 * whole_way_rad / kSteps)
          << step;
      before = now;
    }
  };
  go_on(Control::kBlend, kChange_s, 200);
  EXPECT_GT(max_turned_rad(now, first), 0.1) << "at half of the duration";
  go_on(Control::kPriority, kChange_s, 50);
  go_on(Control::kBlend, kChange_s, 150);
  go_on(Control::kBlend, kSlower_s, 20);
  go_on(Control::kPriority, kSlower_s, 1000);
  EXPECT_TRUE(same_bits(now, first));
}

}  // namespace
}  // namespace marey::retarget
