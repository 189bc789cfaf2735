// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/constraint_targets.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::retarget {
namespace {

// A few roundings of numbers of about 1 m.
constexpr double kRounding_m = 1e-15;

GoalPlaces time_at(const glm::dvec3& p_in_world) {
  GoalPlaces places;
  places.p_in_world = p_in_world;
  return places;
}

/// Returns the one target of a goal that moves the constrained point itself.
glm::dvec3 target(const Goal& goal, const GoalPlaces& places) {
  const PointTargets targets = targets_of(goal, places);
  EXPECT_EQ(targets.all().size(), 1U);
  EXPECT_EQ(targets.all()[0].p_in_world, places.p_in_world);
  return targets.all()[0].target_in_world;
}

TEST(ConstraintTargets, KeepADistanceOnTheSideWhereThePointIs) {
  const DistanceToPoint goal{0.5, {1, 2, 3}};
  EXPECT_LT(glm::distance(target(goal, time_at({1, 2, 5})), {1, 2, 3.5}), kRounding_m);
  EXPECT_LT(glm::distance(target(goal, time_at({0, 2, 3})), {0.5, 2, 3}), kRounding_m);
  // Too near is as wrong as too far.
  EXPECT_LT(glm::distance(target(goal, time_at({1, 2.1, 3})), {1, 2.5, 3}), kRounding_m);
}

TEST(ConstraintTargets, TakeNoDistanceForContactToTheBit) {
  const glm::dvec3 place(0.1, 0.2, -0.3);
  EXPECT_EQ(target(DistanceToPoint{0.0, place}, time_at({5, -7, 0.3})), place);
  EXPECT_EQ(target(DistanceToPoint{0.0, place}, time_at(place)), place);
}

TEST(ConstraintTargets, GoUpFromAPlaceThatHasNoSide) {
  const glm::dvec3 place(0.1, 0.2, -0.3);
  EXPECT_LT(glm::distance(target(DistanceToPoint{0.5, place}, time_at(place)),
                          {0.1, 0.7, -0.3}),
            kRounding_m);
}

TEST(ConstraintTargets, KeepADistanceFromTheOtherPointWhereItIsNow) {
  GoalPlaces places = time_at({1, 0, 0});
  places.other_in_world = {3, 0, 0};
  const glm::dvec3 wanted(2.75, 0, 0);
  EXPECT_EQ(target(DistanceToBody{0.25, {"head", {}}}, places), wanted);
  EXPECT_EQ(target(DistanceToConstraint{0.25, "other"}, places), wanted);
}

TEST(ConstraintTargets, ProjectOntoAnAllowedSpace) {
  const AllowedSpace box{{-1, 0, -1}, {1, 2, 1}};
  EXPECT_EQ(target(box, time_at({0.5, 1, 0})), glm::dvec3(0.5, 1, 0));
  EXPECT_EQ(target(box, time_at({3, 1, -0.5})), glm::dvec3(1, 1, -0.5));
  EXPECT_EQ(target(box, time_at({3, -4, -5})), glm::dvec3(1, 0, -1));
}

TEST(ConstraintTargets, LeaveAForbiddenSpaceByItsNearestFace) {
  const ForbiddenSpace box{{-1, 0, -1}, {1, 3, 1}};
  EXPECT_EQ(target(box, time_at({0.9, 1, 0})), glm::dvec3(1, 1, 0));
  EXPECT_EQ(target(box, time_at({-0.9, 1, 0})), glm::dvec3(-1, 1, 0));
  EXPECT_EQ(target(box, time_at({0.1, 2.8, 0.2})), glm::dvec3(0.1, 3, 0.2));
  EXPECT_EQ(target(box, time_at({0.1, 0.2, 0.2})), glm::dvec3(0.1, 0, 0.2));
  EXPECT_EQ(target(box, time_at({0.1, 1.5, 0.7})), glm::dvec3(0.1, 1.5, 1));
  EXPECT_EQ(target(box, time_at({0.1, 1.5, -0.7})), glm::dvec3(0.1, 1.5, -1));
}

TEST(ConstraintTargets, LeaveAloneWhatIsOutsideAForbiddenSpaceOrOnItsFace) {
  const ForbiddenSpace box{{-1, 0, -1}, {1, 3, 1}};
  for (const glm::dvec3& p : {glm::dvec3(1, 1, 0), {0, 3, 0}, {2, 1, 0}, {5, 5, 5}}) {
    EXPECT_EQ(target(box, time_at(p)), p);
  }
  // A box without a volume has no inside.
  const ForbiddenSpace flat{{-1, 1, -1}, {1, 1, 1}};
  EXPECT_EQ(target(flat, time_at({0, 1, 0})), glm::dvec3(0, 1, 0));
}

TEST(ConstraintTargets, LeaveTheMiddleOfAForbiddenSpaceAlwaysTheSameWay) {
  const ForbiddenSpace cube{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(target(cube, time_at({0, 0, 0})), glm::dvec3(1, 0, 0));
  const ForbiddenSpace long_in_x{{-5, -1, -1}, {5, 1, 1}};
  EXPECT_EQ(target(long_in_x, time_at({0, 0, 0})), glm::dvec3(0, 1, 0));
}

// Never further from the point than any other valid position.
TEST(ConstraintTargets, AreTheNearestPositionsForSpaces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
  const auto some = [&] {
    return glm::dvec3(coordinate(random), coordinate(random), coordinate(random));
  };
  const glm::dvec3 low(-1, -0.5, -1.5);
  const glm::dvec3 high(1, 1.5, 0.5);
  const auto holds = [&](const glm::dvec3& p) {
    return glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high));
  };
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 p = some();
    const glm::dvec3 other = some();
    const glm::dvec3 in = target(AllowedSpace{low, high}, time_at(p));
    const glm::dvec3 out = target(ForbiddenSpace{low, high}, time_at(p));
    EXPECT_FALSE(holds(out));
    EXPECT_EQ(glm::clamp(in, low, high), in);
    EXPECT_LE(glm::distance(p, holds(other) ? in : out), glm::distance(p, other));
  }
}

RigidTransform some_segment() {
  return {glm::normalize(glm::dquat(0.3, -0.5, 0.7, 0.2)), {0.1, 1.2, -0.3}};
}

// Two levers at their targets define one rotation.
TEST(ConstraintTargets, DetermineAWholeOrientation) {
  const glm::dquat wanted = glm::normalize(glm::dquat(0.9, 0.1, -0.4, 0.3));
  GoalPlaces places = time_at({9, 9, 9});
  places.world_from_segment = some_segment();
  const PointTargets found = targets_of(SegmentOrientation{wanted}, places);
  const auto targets = found.all();
  ASSERT_EQ(targets.size(), 2U);
  const glm::dvec3 joint = places.world_from_segment.translation;
  const glm::dvec3 x = (targets[0].target_in_world - joint) / kLever_m;
  const glm::dvec3 y = (targets[1].target_in_world - joint) / kLever_m;
  const glm::dquat from_targets = glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)));
  EXPECT_NEAR(std::abs(glm::dot(from_targets, wanted)), 1.0, 1e-14 /* rounding alone */);
  for (const int i : {0, 1}) {
    const glm::dvec3 in_t_pose(i == 0 ? kLever_m : 0.0, i == 1 ? kLever_m : 0.0, 0.0);
    const auto k = static_cast<std::size_t>(i);
    EXPECT_LT(glm::distance(targets[k].p_in_world, places.world_from_segment * in_t_pose),
              kRounding_m);
  }
}

TEST(ConstraintTargets, MatchTheLeversOfAnOrientationThatIsMet) {
  GoalPlaces places;
  places.world_from_segment = some_segment();
  const Goal goal = SegmentOrientation{places.world_from_segment.rotation};
  const PointTargets found = targets_of(goal, places);
  for (const PointTarget& t : found.all()) {
    EXPECT_EQ(t.p_in_world, t.target_in_world);
  }
}

TEST(ConstraintTargets, MatchTheFootprintOfASupport) {
  GoalPlaces places = time_at({0, 0.3, 0});
  places.footprint_in_world = {0.2, 0.08, 0.1};
  places.footprint_world_from_t_pose = some_segment().rotation;
  const PointTargets as_it_was = targets_of(Support{}, places);
  ASSERT_EQ(as_it_was.all().size(), 3U);
  EXPECT_EQ(as_it_was.all()[0].p_in_world, places.p_in_world);
  EXPECT_EQ(as_it_was.all()[0].target_in_world, places.footprint_in_world);
  EXPECT_LT(glm::distance(as_it_was.all()[1].target_in_world,
                          some_segment().rotation * glm::dvec3(kLever_m, 0, 0)),
            kRounding_m);
  const glm::dquat upright(1, 0, 0, 0);
  const PointTargets placed = targets_of(Support{glm::dvec3(1, 0, 1), upright}, places);
  EXPECT_EQ(placed.all()[0].target_in_world, glm::dvec3(1, 0, 1));
  EXPECT_EQ(placed.all()[2].target_in_world, glm::dvec3(0, kLever_m, 0));
}

}  // namespace
}  // namespace marey::retarget
