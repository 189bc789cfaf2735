// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/foot_course.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {
namespace {

using marey::testing::Dice;

/// A foot that stands for ten frames and leaves at once, fast.
std::vector<retarget::FootPlace> leaving_foot(const glm::dvec3& step_m) {
  std::vector<retarget::FootPlace> out;
  for (int i = 0; i < 20; ++i) {
    retarget::FootPlace place;
    place.ankle_in_world = {0.3, 0.1, -0.2};
    if (i >= 10) {
      place.ankle_in_world += static_cast<double>(i - 9) * step_m;
      place.foot = glm::angleAxis(0.2 * (i - 9), glm::dvec3(1.0, 0.0, 0.0));
    }
    out.push_back(place);
  }
  return out;
}

TEST(FootCourse, KeepsAStandingFootStillUpToItsLastFrame) {
  Dice dice(5);
  for (int round = 0; round < 200; ++round) {
    const auto foot = leaving_foot(dice.between(0.005, 0.1) * dice.direction());
    std::vector<double> at;
    for (double frame = 0.0; frame <= 9.0; frame += dice.between(0.1, 0.9)) {
      at.push_back(frame);
    }
    for (const retarget::FootPlace& place : foot_course(foot, at)) {
      EXPECT_NEAR(glm::distance(place.ankle_in_world, foot[0].ankle_in_world), 0, 1e-15);
      EXPECT_NEAR(std::abs(place.foot.w), 1.0, 1e-15);
    }
  }
}

TEST(FootCourse, DoesNotOvershootBetweenFrames) {
  Dice dice(6);
  for (int round = 0; round < 200; ++round) {
    std::vector<retarget::FootPlace> foot(12);
    for (retarget::FootPlace& place : foot) {
      place.ankle_in_world = dice.between(0.0, 1.0) * dice.direction();
    }
    std::vector<double> at;
    for (double frame = 0.0; frame < 11.0; frame += 0.05) at.push_back(frame);
    const auto course = foot_course(foot, at);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto before = static_cast<std::size_t>(at[k]);
      for (int axis = 0; axis < 3; ++axis) {
        const double a = foot[before].ankle_in_world[axis];
        const double b = foot[before + 1].ankle_in_world[axis];
        EXPECT_GE(course[k].ankle_in_world[axis], std::min(a, b) - 1e-12);
        EXPECT_LE(course[k].ankle_in_world[axis], std::max(a, b) + 1e-12);
      }
    }
  }
}

TEST(FootCourse, GivesFramesToTheBit) {
  const auto foot = leaving_foot({0.01, 0.02, 0.03});
  const auto course = foot_course(foot, std::vector<double>{0.0, 9.0, 13.0, 19.0});
  EXPECT_EQ(course[1].ankle_in_world, foot[9].ankle_in_world);
  EXPECT_EQ(course[2].foot, foot[13].foot);
  EXPECT_EQ(course[3].ankle_in_world, foot[19].ankle_in_world);
}

TEST(FootCourse, IsALineForASteadyFoot) {
  std::vector<retarget::FootPlace> foot(10);
  for (std::size_t i = 0; i < foot.size(); ++i) {
    foot[i].ankle_in_world = {0.1 * static_cast<double>(i), 1.0, 0.0};
  }
  const auto course = foot_course(foot, std::vector<double>{2.25, 4.5, 6.75});
  EXPECT_NEAR(course[0].ankle_in_world.x, 0.225, 1e-12);
  EXPECT_NEAR(course[1].ankle_in_world.x, 0.45, 1e-12);
  EXPECT_NEAR(course[2].ankle_in_world.x, 0.675, 1e-12);
}

}  // namespace
}  // namespace marey::edit
