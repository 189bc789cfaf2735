// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/point_figures.h"

#include <gtest/gtest.h>

#include "tests/app/stage/figures/made_figure_body.h"

namespace marey::app {
namespace {

const BodyPoint kRightHand{"rightHand", {-0.05, 0.0, 0.0}};

TEST(PointFigures, PointsLieAsInTheTPose) {
  const MadeFigureBody made;
  const auto point = find_point(made.body(), kRightHand);
  ASSERT_TRUE(point);
  const glm::dvec3 place = point_path(made.body(), *point)[7];
  const glm::dvec3 expected = made.place(HumanBone::kRightHand) - glm::dvec3(0.05, 0, 0);
  EXPECT_NEAR(glm::distance(place, expected), 0.0, 1e-9);
  EXPECT_FALSE(find_point(made.body(), {"thirdHand", {}}));
}

TEST(PointFigures, TheWorstErrorAndItsTimeAreFound) {
  const MadeFigureBody made;
  const auto point = find_point(made.body(), kRightHand);
  std::vector<glm::dvec3> targets = point_path(made.body(), *point);
  for (auto& target : targets) target.x += 0.0005;
  targets[40].z += 0.012;
  targets[41].x += 0.020;
  const ReachedError all = reached_error_mm(made.body(), *point, targets, {});
  EXPECT_EQ(all.beyond, 0U);
  EXPECT_NEAR(all.error_mm.value, 20.5, 1e-6);
  EXPECT_NEAR(all.error_mm.time_s, 41 / 60.0, 1e-12);
  const ReachedError late = reached_error_mm(made.body(), *point, targets, {0.8, {}});
  EXPECT_NEAR(late.error_mm.value, 0.5, 1e-6);
}

TEST(PointFigures, TargetsOutOfReachDoNotCount) {
  const MadeFigureBody made;
  const auto point = find_point(made.body(), kRightHand);
  std::vector<glm::dvec3> targets = point_path(made.body(), *point);
  for (std::size_t i = 60; i < 120; ++i) targets[i].x -= 0.01;  // The arm is straight.
  const ReachedError error = reached_error_mm(made.body(), *point, targets, {});
  EXPECT_EQ(error.beyond, 60U);
  EXPECT_NEAR(error.error_mm.value, 0.0, 1e-6);
}

TEST(PointFigures, ATargetThatOnlyThePostureBeforeReachesCounts) {
  MadeFigureBody made;
  const auto point = find_point(made.body(), kRightHand);
  const std::vector<glm::dvec3> targets = point_path(made.body(), *point);
  made.poses[90].root_in_world.x += 0.3;  // The body moved away from its target.
  const ReachedError error = reached_error_mm(made.body(), *point, targets, {});
  EXPECT_EQ(error.beyond, 0U);
  EXPECT_NEAR(error.error_mm.value, 300.0, 1e-6);
}

TEST(PointFigures, ClearanceIsTheSmallestDistance) {
  const MadeFigureBody made;
  const auto point = find_point(made.body(), {"head", {0.0, 0.1, 0.0}});
  const glm::dvec3 head = point_path(made.body(), *point)[0];
  std::vector<glm::dvec3> targets;
  for (int i = 0; i < 120; ++i) {
    targets.push_back(head + glm::dvec3(0.0, 0.0, 0.09 + 0.01 * std::abs(i - 30)));
  }
  const WorstValue clearance = clearance_mm(made.body(), *point, targets, {});
  EXPECT_NEAR(clearance.value, 90.0, 1e-6);
  EXPECT_NEAR(clearance.time_s, 0.5, 1e-12);
}

TEST(PointFigures, InstantsBetweenStepsAreInterpolated) {
  MadeFigureBody made;
  const auto point = find_point(made.body(), kRightHand);
  for (std::size_t i = 0; i < 120; ++i) {
    made.poses[i].root_in_world.z = 0.6 * made.times_s[i];
  }
  const glm::dvec3 start = point_path(made.body(), *point)[0];
  const std::vector<glm::dvec3> targets(120, start);
  EXPECT_NEAR(distance_at_mm(made.body(), *point, targets, 1.0041), 602.46, 1e-6);
  EXPECT_NEAR(distance_at_mm(made.body(), *point, targets, -3.0), 0.0, 1e-6);
}

}  // namespace
}  // namespace marey::app
