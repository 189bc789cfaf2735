// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "retarget/adapt/measure_departure.h"
#include "tests/retarget/adapter_bodies.h"

/// Limits of the departure from the reference caused by balance.
namespace marey::retarget {
namespace {

AdaptOptions balanced_options() {
  AdaptOptions options;
  options.balance = BalanceMode::kHorizontal;
  return options;
}

/// Returns the largest rotation in the world of a segment outside arms and legs. [rad]
double trunk_turn_rad(const Character& body, const Pose& a, const Pose& b) {
  double maximum = 0.0;
  for (const char* segment : {"hips", "spine", "chest", "upperChest", "neck", "head"}) {
    maximum = std::max(
        maximum,
        angle_between_rad(rotation_of(body, a, segment), rotation_of(body, b, segment)));
  }
  return maximum;
}

/// Both feet are standing, and the left hand has a target in front of its shoulder that
/// the arm reaches without the trunk.
ConstraintSet reach(const Character& body, const Pose& reference, Dice& dice) {
  const glm::dvec3 shoulder = place_of(body, reference, {"leftUpperArm"});
  const glm::dvec3 elbow = place_of(body, reference, {"leftLowerArm"});
  const glm::dvec3 wrist = place_of(body, reference, {"leftHand"});
  const double arm_m = glm::distance(shoulder, elbow) + glm::distance(elbow, wrist);
  glm::dvec3 to = dice.direction();
  to.x = std::abs(to.x);
  to.z = std::abs(to.z);
  const glm::dvec3 target = shoulder + dice.between(0.5, 0.9) * arm_m * to;
  return {{standing("left", "leftFoot"),
           standing("right", "rightFoot"),
           contact("hand", "leftHand", target)},
          {}};
}

class AdapterDeparture : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Adapter,
                         AdapterDeparture,
                         ::testing::Bool(),
                         [](const auto& each) {
                           return each.param ? "within_limits" : "without_limits";
                         });

// The centre of mass moves by some 15 mm as an arm is extended: the hips compensate this,
// and the chest is unchanged.
TEST_P(AdapterDeparture, BalanceLeavesTheTrunkAloneWhereTheArmReaches) {
  const Character body = human(GetParam());
  const Pose reference = waiting(body);
  const glm::dvec3 wanted = centre_of_mass(body, reference);
  Dice dice(61);
  int tried = 0;
  for (int i = 0; i < 200; ++i) {
    const ConstraintSet asked = reach(body, reference, dice);
    const Pose alone = adapted(body, asked, reference).pose;
    if (trunk_turn_rad(body, alone, reference) > 1e-6) continue;
    ++tried;
    const Pose out = adapted(body, asked, reference, balanced_options()).pose;
    EXPECT_LT(trunk_turn_rad(body, out, reference), 5.0 * kRadiansPerDegree) << i;
    const auto& goal = std::get<DistanceToPoint>(asked.constraints[2].goal);
    EXPECT_LT(glm::distance(place_of(body, out, {"leftHand"}), goal.p_in_world), 1e-3)
        << i;
    const glm::dvec3 off = centre_of_mass(body, out) - wanted;
    EXPECT_LT(std::hypot(off.x, off.z), 2e-4) << i;
  }
  EXPECT_GT(tried, 100) << "of 200";
}

// The other arm has no target: it keeps its captured rotation, beyond its limits or not.
// Previously the first step of balance moved it within its limits.
TEST(AdapterDepartureFromBeyond, LeavesWhatIsBeyondItsLimitsAsItWas) {
  const Character body = human(true);
  Pose reference = waiting(body);
  glm::dquat& elbow = reference.parent_from_joint[joint_at(body, "rightLowerArm")];
  elbow = glm::angleAxis(-0.5, human_limbs()[1].hinge_axis);
  ASSERT_GT(beyond_limits_rad(body, reference, {}), 0.2);
  Dice dice(62);
  for (int i = 0; i < 50; ++i) {
    const ConstraintSet asked = reach(body, reference, dice);
    const Pose out = adapted(body, asked, reference, balanced_options()).pose;
    const std::size_t joint = joint_at(body, "rightLowerArm");
    EXPECT_LT(angle_between_rad(out.parent_from_joint[joint],
                                reference.parent_from_joint[joint]),
              10.0 * kRadiansPerDegree)
        << i;
  }
}

TEST(MeasureDeparture, ReportsSegmentFrameAndAngle) {
  const Character body = human(false);
  Motion source{body.skeleton, {30.0}, 0, {4, waiting(body)}};
  Motion turned = source;
  glm::dquat& chest = turned.poses[2].parent_from_joint[joint_at(body, "chest")];
  chest = chest * glm::angleAxis(0.6, glm::dvec3(0, 1, 0));
  const auto segments = measure_departure(source, turned);
  ASSERT_EQ(segments.size(), body.skeleton.joints.size());
  const SegmentDeparture& of_chest = segments[joint_at(body, "chest")];
  EXPECT_NEAR(of_chest.worst_rad, 0.6, 1e-9);
  EXPECT_NEAR(of_chest.mean_rad, 0.15, 1e-9);
  EXPECT_EQ(of_chest.worst_frame, 2);
  // Descendants rotate with it, ancestors do not.
  EXPECT_NEAR(segments[joint_at(body, "head")].worst_rad, 0.6, 1e-9);
  EXPECT_NEAR(segments[joint_at(body, "spine")].worst_rad, 0.0, 1e-9);

  const std::vector<JointIndex> joints{static_cast<JointIndex>(joint_at(body, "spine")),
                                       static_cast<JointIndex>(joint_at(body, "chest"))};
  const auto frames = furthest_departures(source, turned, joints);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_NEAR(frames[2].rad, 0.6, 1e-9);
  EXPECT_EQ(frames[2].joint, joints[1]);
  EXPECT_NEAR(frames[1].rad, 0.0, 1e-9);
}

}  // namespace
}  // namespace marey::retarget
