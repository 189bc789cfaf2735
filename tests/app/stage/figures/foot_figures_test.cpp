// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/foot_figures.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

glm::dquat yaw_deg(double angle_deg) {
  return glm::angleAxis(glm::radians(angle_deg), glm::dvec3(0.0, 1.0, 0.0));
}

std::vector<FootStep> still_foot(FootStance stance, int steps) {
  std::vector<FootStep> out;
  for (int i = 0; i < steps; ++i) {
    out.push_back({i / 60.0, stance, {0.1, 0.09, 0.2}, {0.1, 0.03, 0.35}, yaw_deg(10)});
  }
  return out;
}

TEST(FootFigures, AStillFootNeitherSlidesNorTwists) {
  const auto steps = still_foot(FootStance::kFlat, 30);
  EXPECT_EQ(foot_slide_mm(steps).value, 0.0);
  EXPECT_EQ(foot_slide_mm(steps).count, 30U);
  EXPECT_NEAR(foot_twist_deg(steps).value, 0.0, 1e-9);
}

TEST(FootFigures, ASlideIsMeasuredFromTheBeginningOfTheStance) {
  auto steps = still_foot(FootStance::kFlat, 30);
  for (std::size_t i = 10; i < 30; ++i) {
    steps[i].ankle_on_floor += glm::dvec3(0.003, 0.5, 0.004);  // Heights do not count.
    steps[i].ball_on_floor += glm::dvec3(0.003, 0.0, 0.004);
  }
  const WorstValue slide = foot_slide_mm(steps);
  EXPECT_NEAR(slide.value, 5.0, 1e-9);
  EXPECT_NEAR(slide.time_s, 10 / 60.0, 1e-12);
  for (std::size_t i = 0; i < 10; ++i) steps[i].stance = FootStance::kNone;
  EXPECT_NEAR(foot_slide_mm(steps).value, 0.0, 1e-9);
}

TEST(FootFigures, AFootThatTurnsAboutItsBallDoesNotSlide) {
  auto steps = still_foot(FootStance::kFlat, 10);
  steps[7].ankle_on_floor.x += 0.05;
  EXPECT_NEAR(foot_slide_mm(steps).value, 0.0, 1e-9);
  steps[7].ball_on_floor.x += 0.02;
  EXPECT_NEAR(foot_slide_mm(steps).value, 20.0, 1e-9);
}

TEST(FootFigures, OnlyTheStandingPointCounts) {
  for (const bool on_ball : {false, true}) {
    auto steps = still_foot(on_ball ? FootStance::kBall : FootStance::kHeel, 5);
    glm::dvec3& moved = on_ball ? steps[3].ankle_on_floor : steps[3].ball_on_floor;
    moved.x += 0.05;
    EXPECT_NEAR(foot_slide_mm(steps).value, 0.0, 1e-9);
    glm::dvec3& stands = on_ball ? steps[4].ball_on_floor : steps[4].ankle_on_floor;
    stands.z -= 0.002;
    EXPECT_NEAR(foot_slide_mm(steps).value, 2.0, 1e-9);
  }
}

TEST(FootFigures, TwistIsTheTurnAboutTheVerticalAlone) {
  auto steps = still_foot(FootStance::kBall, 20);
  for (std::size_t i = 0; i < 20; ++i) {
    const double angle_rad = 0.04 * static_cast<double>(i);
    const glm::dquat rise = glm::angleAxis(angle_rad, glm::dvec3(1.0, 0.0, 0.0));
    steps[i].world_from_t_pose = yaw_deg(170.0 + (i > 12 ? 15.0 : 0.0)) * rise;
  }
  const WorstValue twist = foot_twist_deg(steps);
  EXPECT_NEAR(twist.value, 15.0, 1e-9);
  EXPECT_NEAR(twist.time_s, 13 / 60.0, 1e-12);
}

TEST(FootFigures, NoStanceHasNoValue) {
  EXPECT_EQ(foot_slide_mm(still_foot(FootStance::kNone, 5)).count, 0U);
  EXPECT_EQ(foot_twist_deg({}).count, 0U);
}

TEST(FootFigures, TheRaisedPartDoesNotStand) {
  EXPECT_EQ(stance_of(0.0, 0.0, 0.01), FootStance::kFlat);
  EXPECT_EQ(stance_of(0.03, 0.0, 0.01), FootStance::kBall);
  EXPECT_EQ(stance_of(0.0, 0.03, 0.01), FootStance::kHeel);
  EXPECT_EQ(stance_of(0.03, 0.025, 0.01), FootStance::kFlat);
}

}  // namespace
}  // namespace marey::app
