// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/retarget/adapter_bodies.h"

/// A body that carries a load leans away from it.
namespace marey::retarget {
namespace {

// A bag in the left hand, held forward.
Pose holding_out(const Character& body) {
  Pose pose = waiting(body);
  pose.parent_from_joint[joint_at(body, "leftUpperArm")] =
      glm::angleAxis(-1.2, glm::dvec3(0, 1, 0));
  return pose;
}

ConstraintSet on_both_feet() {
  return {{standing("left", "leftFoot"), standing("right", "rightFoot")}, {}};
}

class AdapterLoad : public EveryMethod {
 protected:
  static AdaptOptions balanced() {
    AdaptOptions wanted = options();
    wanted.balance = BalanceMode::kHorizontal;
    return wanted;
  }
};
INSTANTIATE_TEST_SUITE_P(Adapter, AdapterLoad, both_methods(), name_of);

TEST_P(AdapterLoad, MovesThePelvisAwayAndBackAgain) {
  const Character body = human(false);
  const Pose reference = holding_out(body);
  Adapter adapter = make_adapter(body, on_both_feet(), balanced());
  adapter.set_balance_target(centre_of_mass(body, reference));
  Pose without;
  Pose with;
  Pose after;
  ASSERT_TRUE(adapter.carry("bag", false));
  static_cast<void>(adapter.adapt(reference, 0.0, without));
  ASSERT_TRUE(adapter.carry("bag", true));
  static_cast<void>(adapter.adapt(reference, 0.0, with));
  ASSERT_TRUE(adapter.carry("bag", false));
  static_cast<void>(adapter.adapt(reference, 0.0, after));
  EXPECT_TRUE(same_bits(without, after));

  glm::dvec3 to_load =
      place_of(body, reference, {"leftHand"}) - centre_of_mass(body, reference);
  to_load.y = 0.0;
  const double moved_m =
      glm::dot(with.root_in_world - without.root_in_world, glm::normalize(to_load));
  // 10 of 80 kg, half a metre forward: the rest of the body moves back by some 6 cm.
  EXPECT_LT(moved_m, -0.03);
  EXPECT_GT(moved_m, -0.12);
  glm::dvec3 off =
      centre_of_mass(body, with, true) - centre_of_mass(body, reference, false);
  off.y = 0.0;
  EXPECT_LT(glm::length(off), balanced().balance_precision_m + 1e-6);
}

// The reference was captured without it (Kulpa 2005, 7.2.1).
TEST_P(AdapterLoad, IsBalancedWhereTheReferenceIsWithoutIt) {
  const Character body = human(false);
  const Pose reference = holding_out(body);
  Adapter adapter = make_adapter(body, on_both_feet(), balanced());
  Pose with;
  ASSERT_TRUE(adapter.carry("bag", true));
  static_cast<void>(adapter.adapt(reference, 0.0, with));
  glm::dvec3 off =
      centre_of_mass(body, with, true) - centre_of_mass(body, reference, false);
  off.y = 0.0;
  EXPECT_LT(glm::length(off), balanced().balance_precision_m + 1e-6);
}

TEST_P(AdapterLoad, IsRefusedByANameThatIsNotThere) {
  Adapter adapter = make_adapter(human(false), {}, options());
  EXPECT_FALSE(adapter.carry("piano", true));
}

}  // namespace
}  // namespace marey::retarget
