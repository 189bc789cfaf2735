// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/kernel/thesis_kinetics.h"

#include <cmath>

#include "retarget/constraints/resolve_segment.h"
#include "tests/retarget/adapt/kernel/thesis_scene.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

/// Annex C of the thesis, simplified: from the distance of the limb's centre from its
/// root to the distance of its end.
struct LimbMasses {
  double l1, l2, r1, r2, m1, m2;
  [[nodiscard]] double extension(double d) const {
    const double r3 = m2 / (m1 + m2);
    const double a = (1 - r3) * r1 + r3 * (1 - r2);
    const double b = r2 * r3;
    const double f = l1 * l1 * a * (a + b) - l2 * l2 * a * b;
    return std::sqrt((d * d - f) / (b * (a + b)));
  }
  /// The same from the triangle itself: distances of centre and end for a bend.
  [[nodiscard]] std::pair<double, double> at(double bend_rad) const {
    const glm::dvec2 elbow(l1, 0);
    const glm::dvec2 lower = l2 * glm::dvec2(std::cos(bend_rad), std::sin(bend_rad));
    const glm::dvec2 centre = (m1 * r1 * elbow + m2 * (elbow + r2 * lower)) / (m1 + m2);
    return {glm::length(centre), glm::length(elbow + lower)};
  }
};

// Verifies the tests' own reference: the formula that the next test uses.
TEST(ThesisExtension, MatchesTheTriangle) {
  testing::Dice dice(3);
  for (int k = 0; k < 1000; ++k) {
    const LimbMasses limb{dice.between(0.2, 0.5),
                          dice.between(0.2, 0.5),
                          dice.between(0.3, 0.6),
                          dice.between(0.3, 0.6),
                          dice.between(0.5, 9.0),
                          dice.between(0.5, 9.0)};
    const auto [centre, end] = limb.at(dice.between(0.0, 2.8));
    // The square root loses half of the digits where the limb is nearly folded.
    EXPECT_NEAR(limb.extension(centre), end, 1e-9);
  }
}

// An arm with two masses on its bones, with a target for which eq. 5.6 has the solution.
TEST(ThesisLimb, BendsByEquation56WhenItsMassesAreOnItsBones) {
  Character character = thesis_human();
  const Pose pose = standing_pose(character);
  const auto joint = [&](const char* name) {
    return *resolve_segment(character.skeleton, name);
  };
  const glm::dvec3 upper_bone =
      character.skeleton[joint("leftLowerArm")].parent_from_joint.translation;
  const glm::dvec3 lower_bone =
      character.skeleton[joint("leftHand")].parent_from_joint.translation;
  const LimbMasses masses{
      glm::length(upper_bone), glm::length(lower_bone), 0.436, 0.43, 2.0, 1.5};
  character.loads.clear();
  character.masses = {{joint("hips"), glm::dvec3(0), 60.0},
                      {joint("leftUpperArm"), 0.436 * upper_bone, masses.m1},
                      {joint("leftLowerArm"), 0.43 * lower_bone, masses.m2}};
  for (const double bend_rad : {0.1, 0.7, 1.5, 2.5}) {
    const auto [centre_m, end_m] = masses.at(bend_rad);
    const glm::dvec3 shoulder = place_in_world(character, pose, "leftUpperArm");
    const glm::dvec3 wanted =
        shoulder + centre_m * glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const double share = (masses.m1 + masses.m2) / (60.0 + masses.m1 + masses.m2);
    ThesisLane lane(character, {}, pose, BalanceMode::k3d);
    lane.lanes.com_target =
        vec_of((share * (wanted - pose.root_in_world)) / lane.body.unit_m);
    const KineticGroup& arm = lane.balancing("leftUpperArm");
    balance_with_limb(lane.plan, arm, {}, balance_error(lane.lanes), true, lane.lanes);
    const double length_m =
        lane.body.unit_m * length(lane.lanes.place[lane.joint("leftHand")] -
                                  lane.lanes.place[lane.joint("leftUpperArm")]);
    EXPECT_NEAR(length_m, masses.extension(centre_m), 1e-6 /* loaded in float */);
    EXPECT_NEAR(length_m, end_m, 1e-6);
  }
}

// Hands and feet are included, for any position of their centres, in one step: annex C
// omits them.
TEST(ThesisLimb, BringsItsCentreExactlyWhereItIsWanted) {
  const Character character = thesis_human();
  const Pose pose = standing_pose(character);
  testing::Dice dice(9);
  for (const char* root : {"leftUpperArm", "rightUpperArm", "leftUpperLeg"}) {
    for (int k = 0; k < 50; ++k) {
      ThesisLane lane(character, {}, pose, BalanceMode::k3d);
      const KineticGroup& limb = lane.balancing(root);
      const auto u = static_cast<std::size_t>(limb.root);
      const double share = lane.lanes.below_mass[u];
      const Vec3<double> now = (1.0 / share) * lane.lanes.below_moment[u];
      // Within reach: a distance from the root slightly larger or smaller.
      const double reach = length(now - lane.lanes.place[u]);
      const Vec3<double> wanted = lane.lanes.place[u] + vec_of(dice.between(0.6, 0.95) *
                                                               reach * dice.direction());
      lane.lanes.com_target = lane.lanes.com + share * (wanted - now);
      for (const bool keeps_orientation : {false, true}) {
        ThesisLane moved = lane;
        SolveSettings settings;
        settings.keeps_orientation = keeps_orientation;
        balance_with_limb(
            moved.plan, limb, settings, balance_error(moved.lanes), true, moved.lanes);
        measure_balance(moved.plan, moved.lanes);
        EXPECT_LT(length(balance_error(moved.lanes)), 1e-7 /* loaded in float */)
            << root << ", hand " << (keeps_orientation ? "kept" : "follows");
      }
    }
  }
}

TEST(ThesisLimb, GoesUnderTheWantedPlaceInHorizontalMode) {
  const Character character = thesis_human();
  const Pose pose = standing_pose(character);
  ThesisLane lane(character, {}, pose, BalanceMode::kHorizontal);
  const KineticGroup& arm = lane.balancing("leftUpperArm");
  lane.lanes.com_target = lane.lanes.com + vec_of({0.004, 0.5, 0.005});
  balance_with_limb(lane.plan, arm, {}, balance_error(lane.lanes), true, lane.lanes);
  measure_balance(lane.plan, lane.lanes);
  EXPECT_LT(length(balance_error(lane.lanes)), 1e-7);
}

TEST(ThesisLimb, StretchesTowardsWhatIsOutOfReach) {
  const Character character = thesis_human();
  const Pose pose = standing_pose(character);
  ThesisLane lane(character, {}, pose, BalanceMode::k3d);
  const KineticGroup& arm = lane.balancing("leftUpperArm");
  lane.lanes.com_target = lane.lanes.com + vec_of({0.5, 0.0, 0.0});
  balance_with_limb(lane.plan, arm, {}, balance_error(lane.lanes), true, lane.lanes);
  const auto at = [&](const char* name) { return lane.lanes.place[lane.joint(name)]; };
  const double bones = length(at("leftLowerArm") - at("leftUpperArm")) +
                       length(at("leftHand") - at("leftLowerArm"));
  // The centre is farthest when the masses line up; the hand's is a little off its bone.
  EXPECT_GT(length(at("leftHand") - at("leftUpperArm")), 0.995 * bones);
}

// Figure 5.8: in the plane a rotation cannot move the centre to a target far below; it
// moves it above the target, not to the nearest point.
TEST(ThesisRotation, ComesOverTheWantedPlaceNotNearestToIt) {
  const Vec3<double> from{0.0, 0.4, 0.0};
  const Vec3<double> wanted{0.2, 0.1, 0.1};
  const Vec3<double> over = reached_by_turning(from, wanted, 0.0);
  EXPECT_DOUBLE_EQ(over.x, 0.2);
  EXPECT_DOUBLE_EQ(over.z, 0.1);
  EXPECT_GT(over.y, 0.0);
  EXPECT_NEAR(length(over), 0.4, 1e-12);
  // In three dimensions on the line to it.
  EXPECT_LT(length(cross(reached_by_turning(from, wanted, 1.0), wanted)), 1e-12);
  // Out of horizontal reach: as far as possible.
  const Vec3<double> far = reached_by_turning(from, {3.0, 0.4, 4.0}, 0.0);
  EXPECT_NEAR(far.x, 0.24, 1e-12);
  EXPECT_NEAR(far.z, 0.32, 1e-12);
}

TEST(ThesisTrunk, BringsTheBodysCentreNearerByOneRotation) {
  const Character character = thesis_human();
  const Pose pose = standing_pose(character);
  for (const BalanceMode mode : {BalanceMode::kHorizontal, BalanceMode::k3d}) {
    ThesisLane lane(character, {}, pose, mode);
    const KineticGroup& trunk = lane.balancing("spine");
    EXPECT_EQ(trunk.root, lane.shape.groups.balancing.front().root) << "heaviest first";
    lane.lanes.com_target = lane.lanes.com + vec_of({0.02, 0.0, -0.04});
    const double before = length(balance_error(lane.lanes));
    balance_with_segment(lane.plan, trunk, balance_error(lane.lanes), true, lane.lanes);
    measure_balance(lane.plan, lane.lanes);
    // Over the target to first order, because the rotation is shared over vertebrae; in
    // three dimensions a rotation keeps the distance from its root.
    const double left = mode == BalanceMode::kHorizontal ? 0.15 : 0.5;
    EXPECT_LT(length(balance_error(lane.lanes)), left * before);
  }
}

TEST(ThesisMasses, AreKeptUpGroupByGroup) {
  const Character character = thesis_human();
  ThesisLane lane(character, {}, standing_pose(character), BalanceMode::k3d);
  lane.lanes.com_target = lane.lanes.com + vec_of({0.05, 0.02, -0.03});
  for (const KineticGroup& group : lane.shape.groups.balancing) {
    if (group.limb >= 0) {
      balance_with_limb(
          lane.plan, group, {}, balance_error(lane.lanes), true, lane.lanes);
    } else {
      balance_with_segment(lane.plan, group, balance_error(lane.lanes), true, lane.lanes);
    }
    update_balance(lane.plan, group.below, lane.lanes);
    const Vec3<double> kept = lane.lanes.com;
    const std::vector<Vec3<double>> moments = lane.lanes.below_moment;
    measure_balance(lane.plan, lane.lanes);
    EXPECT_LT(length(lane.lanes.com - kept), 1e-12);
    for (const int j : lane.plan.live) {
      const auto i = static_cast<std::size_t>(j);
      EXPECT_LT(length(lane.lanes.below_moment[i] - moments[i]), 1e-12);
    }
  }
}

// Thesis 5.3.1: groups that kinematics uses, also by its range, are not used by kinetics.
TEST(ThesisGroups, BalanceOnlyWhileNoWishUsesThem) {
  const Character character = thesis_human();
  const Pose pose = standing_pose(character);
  ConstraintSet set{{contact_of("leftHand", {0.2, 1.0, 0.3})}, {}};
  const auto is_free_in = [&](const ThesisLane& lane, const char* root) {
    return is_free(lane.balancing(root), lane.lanes);
  };
  ThesisLane whole(character, set, pose, BalanceMode::kHorizontal);
  EXPECT_FALSE(is_free_in(whole, "leftUpperArm"));
  EXPECT_FALSE(is_free_in(whole, "spine"));
  EXPECT_TRUE(is_free_in(whole, "rightUpperArm"));
  EXPECT_TRUE(is_free_in(whole, "leftUpperLeg"));
  set.constraints[0].range = 3;
  ThesisLane arm(character, set, pose, BalanceMode::kHorizontal);
  EXPECT_FALSE(is_free_in(arm, "leftUpperArm"));
  EXPECT_TRUE(is_free_in(arm, "spine"));
  whole.lanes.points[0].active = 0.0;
  EXPECT_TRUE(is_free_in(whole, "leftUpperArm"));
}

}  // namespace
}  // namespace marey::retarget
