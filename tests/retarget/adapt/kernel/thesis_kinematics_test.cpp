// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/kernel/thesis_kinematics.h"

#include <cmath>

#include "tests/retarget/adapt/kernel/thesis_scene.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

// Lanes are loaded in single precision and computed in double.
constexpr double kRounding = 1e-9;

Quat<double> quat_of(const glm::dquat& q) {
  return {q.w, q.x, q.y, q.z};
}

// A head with a target elsewhere: the neck rotates for it as one rigid segment.
ThesisLane nodding(const glm::dvec3& target_in_world) {
  const Character character = thesis_human();
  ConstraintSet set{{contact_of("head", target_in_world)}, {}};
  set.constraints[0].point.offset_in_t_pose = {0.03, 0.1, 0.08};
  return {character, set, rest_pose(character.skeleton)};
}

double error_after(ThesisLane lane, const ThesisTurn& turn, const Quat<double>& by) {
  turn_joints(lane.plan, turn.joints, turn.below, by, true, lane.lanes);
  measure_target(lane.plan, 0, lane.lanes);
  return length(lane.lanes.points[0].error);
}

TEST(ThesisSegment, TurnsSoThatNoOtherTurnBringsItsPointNearer) {
  const ThesisLane lane = nodding({0.3, 1.6, 0.2});
  const ThesisTurn& neck = lane.turn_of("neck");
  ThesisLane adapted = lane;
  adapt_segment(adapted.plan, adapted.shape.groups, neck, {}, 1.0, true, adapted.lanes);
  measure_target(adapted.plan, 0, adapted.lanes);
  const double error = length(adapted.lanes.points[0].error);
  EXPECT_LT(error, 0.9 * length(lane.lanes.points[0].error));
  testing::Dice dice(5);
  for (int k = 0; k < 200; ++k) {
    const Quat<double> other = quat_of(dice.turn(k < 100 ? 3.0 : 0.05));
    EXPECT_GE(error_after(adapted, neck, other), error - kRounding);
  }
}

// The rotation is the smallest solution: its axis is perpendicular to the line to the
// point.
TEST(ThesisSegment, DoesNotSpinForOneWish) {
  ThesisLane lane = nodding({0.3, 1.6, 0.2});
  const ThesisTurn& neck = lane.turn_of("neck");
  const auto j = static_cast<std::size_t>(neck.joints.front());
  const Vec3<double> line = lane.lanes.points[0].place - lane.lanes.place[j];
  const Quat<double> before = lane.lanes.rotation[j];
  adapt_segment(lane.plan, lane.shape.groups, neck, {}, 1.0, true, lane.lanes);
  const Quat<double> turn = lane.lanes.rotation[j] * conjugate(before);
  EXPECT_GT(length(vector_part(turn)), 0.05);
  EXPECT_NEAR(dot(vector_part(turn), line), 0.0, 1e-7 /* quaternions in float */);
}

// A target with an error well within its precision causes no rotation (the thesis prints
// the opposite, with rotations only for met targets); one at its precision the full
// rotation.
TEST(ThesisSegment, StaysForAWishThatIsMet) {
  ThesisLane lane = nodding({0.3, 1.6, 0.2});
  const double error = length(lane.lanes.points[0].error);
  const ThesisTurn& neck = lane.turn_of("neck");
  const auto j = static_cast<std::size_t>(neck.joints.front());
  const Quat<double> before = lane.lanes.rotation[j];
  lane.lanes.points[0].per_precision = 1.0 / (2.01 * error);
  adapt_segment(lane.plan, lane.shape.groups, neck, {}, 1.0, true, lane.lanes);
  EXPECT_EQ(lane.lanes.rotation[j].w, before.w);
  lane.lanes.points[0].per_precision = 1.0 / (0.99 * error);
  adapt_segment(lane.plan, lane.shape.groups, neck, {}, 1.0, true, lane.lanes);
  measure_target(lane.plan, 0, lane.lanes);
  const Vec3<double> place = lane.lanes.points[0].place - lane.lanes.place[j];
  const Vec3<double> target = lane.lanes.points[0].target - lane.lanes.place[j];
  EXPECT_LT(length(cross(place, target)), 1e-6 /* rotations in float */);
}

ThesisLane two_wishes(double importance) {
  const Character character = thesis_human();
  ConstraintSet set{{contact_of("head", {0.2, 1.7, 0.1}), contact_of("neck", {0, 0, 0})},
                    {}};
  set.constraints[0].point.offset_in_t_pose = {0.0, 0.15, 0.0};
  set.constraints[0].importance = importance;
  set.constraints[1].id = "ear";
  set.constraints[1].point = {"head", {0.08, 0.1, 0.05}};
  set.constraints[1].goal = DistanceToPoint{0.0, {-0.1, 1.5, 0.3}};
  return {character, set, rest_pose(character.skeleton)};
}

TEST(ThesisSegment, SpinsForTheSecondWishAndKeepsTheFirst) {
  const ThesisLane lane = two_wishes(2.0);
  const ThesisTurn& neck = lane.turn_of("neck");
  // The first alone.
  ThesisLane alone = lane;
  alone.lanes.points[1].active = 0.0;
  adapt_segment(alone.plan, alone.shape.groups, neck, {}, 1.0, true, alone.lanes);
  measure_target(alone.plan, 0, alone.lanes);
  ThesisLane both = lane;
  adapt_segment(both.plan, both.shape.groups, neck, {}, 1.0, true, both.lanes);
  measure_target(both.plan, 0, both.lanes);
  measure_target(both.plan, 1, both.lanes);
  EXPECT_LT(length(both.lanes.points[0].place - alone.lanes.points[0].place), kRounding);
  const double error = length(both.lanes.points[1].error);
  const auto j = static_cast<std::size_t>(neck.joints.front());
  const Vec3<double> axis =
      unit_or(both.lanes.points[0].place - both.lanes.place[j], {0, 1, 0}, 1e-9);
  for (int k = 0; k < 64; ++k) {
    const double half = 0.05 * k;
    const double sine = std::sin(half);
    ThesisLane spun = both;
    turn_joints(spun.plan,
                neck.joints,
                neck.below,
                {std::cos(half), sine * axis.x, sine * axis.y, sine * axis.z},
                true,
                spun.lanes);
    measure_target(spun.plan, 1, spun.lanes);
    EXPECT_GE(length(spun.lanes.points[1].error), error - kRounding);
  }
}

// Thesis 4.2.5, figure 4.20: two opposed targets of importance 2 and 1. The first
// rotation is the weighted mean, and after it the two are in equilibrium.
TEST(ThesisSegment, BlendsOpposedWishesWithoutSwinging) {
  const Character character = thesis_human();
  const Pose pose = rest_pose(character.skeleton);
  const glm::dvec3 neck_at = place_in_world(character, pose, "neck");
  ConstraintSet set;
  for (const double side : {1.0, -1.0}) {
    Constraint c = contact_of("head", {});
    c.id = side > 0 ? "left" : "right";
    const glm::dvec3 head_at = place_in_world(character, pose, "head");
    const glm::dvec3 up = head_at + glm::dvec3(0, 0.2, 0) - neck_at;
    c.point.offset_in_t_pose = {0, 0.2, 0};
    c.goal = DistanceToPoint{
        0.0, neck_at + glm::angleAxis(0.3 * side, glm::dvec3(0, 0, 1)) * up};
    c.importance = side > 0 ? 2.0 : 1.0;
    set.constraints.push_back(c);
  }
  ThesisLane lane(character, set, pose);
  SolveSettings blend;
  blend.blend = true;
  const ThesisTurn& neck = lane.turn_of("neck");
  const auto j = static_cast<std::size_t>(neck.joints.front());
  const Quat<double> start = lane.lanes.rotation[j];
  const auto angle = [&] {
    const Quat<double> q = lane.lanes.rotation[j] * conjugate(start);
    return 2.0 * std::asin(length(vector_part(q)));
  };
  adapt_segment(lane.plan, lane.shape.groups, neck, blend, 1.0, true, lane.lanes);
  EXPECT_NEAR(angle(), 0.1, 3e-4 /* vectors are angles up to their cube over 48 */);
  adapt_segment(lane.plan, lane.shape.groups, neck, blend, 1.0, true, lane.lanes);
  EXPECT_NEAR(angle(), 0.1, 1e-3);
}

TEST(ThesisTrunk, SharesATurnOverItsVertebrae) {
  const Character character = thesis_human();
  ConstraintSet set{{contact_of("leftHand", {0.3, 1.9, 0.6})}, {}};
  ThesisLane lane(character, set, rest_pose(character.skeleton));
  ThesisTurn all;
  for (const char* name : {"spine", "chest", "upperChest"}) {
    all.joints.push_back(static_cast<int>(lane.joint(name)));
  }
  all.below = lane.turn_of("spine").below;
  const double angle = 0.9;
  const Quat<double> turn{std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
  turn_joints(lane.plan, all.joints, all.below, turn, true, lane.lanes);
  double before = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    const Quat<double>& q = lane.lanes.rotation[static_cast<std::size_t>(all.joints[n])];
    const double turned = 2.0 * std::asin(q.z);
    // Equal, up to the difference between chord and arc.
    EXPECT_NEAR(turned - before, angle / 3, 0.01);
    before = turned;
  }
  EXPECT_NEAR(before, angle, 1e-6 /* quaternions in float */);
  // Descendants keep their position in their parent.
  for (const int j : lane.plan.live) {
    if (j == 0) continue;
    const auto i = static_cast<std::size_t>(j);
    const auto p = static_cast<std::size_t>(lane.plan.parent[i]);
    const Vec3<double> offset = rotate(conjugate(lane.lanes.rotation[p]),
                                       lane.lanes.place[i] - lane.lanes.place[p]);
    EXPECT_LT(length(offset - lane.lanes.offset[i]), 1e-6);
  }
}

// Equation 4.1, where the sets' means weighted by their sums are the mean of all.
TEST(ThesisRoot, GoesByTheMeanErrorOfPelvisAndGroups) {
  const Character character = thesis_human();
  const Pose pose = rest_pose(character.skeleton);
  ConstraintSet set{
      {contact_of("hips",
                  place_in_world(character, pose, "hips") + glm::dvec3(0, 0, 0.3)),
       contact_of("leftHand",
                  place_in_world(character, pose, "leftHand") + glm::dvec3(0.2, 0, 0)),
       contact_of("head",
                  place_in_world(character, pose, "head") + glm::dvec3(0, 0.1, 0))},
      {}};
  set.constraints[0].importance = 3.0;
  ThesisLane lane(character, set, pose);
  lane.lanes.root_weight = 0.5;
  lane.lanes.root_weight_on_floor = 0.25;
  const glm::dvec3 wish_m =
      lane.body.unit_m *
      glm_of(mean_root_error(lane.plan, lane.shape.groups, lane.lanes));
  const glm::dvec3 mean_m = glm::dvec3(0.2, 0.1, 3 * 0.3) / 5.0;
  const glm::dvec3 expected_m = mean_m * glm::dvec3(0.25, 0.5, 0.25);
  EXPECT_LT(glm::distance(wish_m, expected_m), 1e-6 /* loaded in float */);
}

// Thesis 5.3.2: kinematics moves the root along axes that kinetics leaves free.
TEST(ThesisRoot, LeavesTheAxesOfBalanceAlone) {
  const Character character = thesis_human();
  const Pose pose = rest_pose(character.skeleton);
  const ConstraintSet set{{contact_of("head", {0.3, 2.0, 0.4})}, {}};
  const auto wish = [&](BalanceMode mode) {
    ThesisLane lane(character, set, pose, mode);
    return mean_root_error(lane.plan, lane.shape.groups, lane.lanes);
  };
  const Vec3<double> free = wish(BalanceMode::kOff);
  EXPECT_GT(std::abs(free.x) * std::abs(free.y) * std::abs(free.z), 0.0);
  const Vec3<double> standing = wish(BalanceMode::kHorizontal);
  EXPECT_EQ(standing.x, 0.0);
  EXPECT_EQ(standing.y, free.y);
  EXPECT_EQ(standing.z, 0.0);
  EXPECT_EQ(length(wish(BalanceMode::k3d)), 0.0);
}

}  // namespace
}  // namespace marey::retarget
