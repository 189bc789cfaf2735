// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/raise_heel.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

FootMap adult_foot(bool has_toes) {
  FootMap out;
  out.ankle_height_m = 0.08;
  out.ball_height_m = 0.02;
  out.ball_from_ankle_in_t_pose = {0.0, -0.06, 0.13};
  out.tip_from_ball_in_t_pose = {0.0, -0.02, 0.06};
  out.has_toes = has_toes;
  return out;
}

glm::dvec3 raised(const HeelLever& lever, double rad) {
  return rotation_from_vector(rad * lever.axis) * lever.ankle_from_pivot;
}

double elevation(const glm::dvec3& v) {
  return std::atan2(v.y, std::hypot(v.x, v.z));
}

TEST(RaiseHeel, BringsTheAnkleToTheWantedDistance) {
  testing::Dice dice(1);
  for (int k = 0; k < 2000; ++k) {
    const FootMap foot = adult_foot(k % 2 == 0);
    const glm::dquat heading =
        glm::angleAxis(dice.between(-3.0, 3.0), glm::dvec3(0, 1, 0)) * dice.turn(0.1);
    const HeelLever lever = heel_lever(foot, heading * -heel_pivot_in_t_pose(foot), 1.0);
    const glm::dvec3 hip =
        lever.ankle_from_pivot +
        glm::dvec3(dice.between(-0.2, 0.2), 0.9, dice.between(-0.2, 0.2));
    const double now_m = glm::distance(hip, lever.ankle_from_pivot);
    const double reach_m = now_m - dice.between(0.0, 0.04);
    const double rad = heel_rise_rad(lever, hip, reach_m);
    EXPECT_GE(rad, 0.0);
    EXPECT_LE(rad, lever.max_rad);
    EXPECT_NEAR(glm::distance(hip, raised(lever, rad)), reach_m, 1e-12) << k;
    EXPECT_GE(raised(lever, rad).y, lever.ankle_from_pivot.y - 1e-12);
  }
}

TEST(RaiseHeel, KeepsTheHeelDownWhereTheLegReaches) {
  const FootMap foot = adult_foot(true);
  const HeelLever lever = heel_lever(foot, -heel_pivot_in_t_pose(foot), 1.0);
  const glm::dvec3 hip = lever.ankle_from_pivot + glm::dvec3(0.0, 0.9, 0.0);
  EXPECT_EQ(heel_rise_rad(lever, hip, 0.91), 0.0);
}

TEST(RaiseHeel, StopsAtTheLargestPitchOfTheSole) {
  const FootMap foot = adult_foot(true);
  for (const double pitch : {-0.2, 0.0, 0.4, 0.9, 1.2}) {
    const glm::dquat tilt = glm::angleAxis(pitch, glm::dvec3(1, 0, 0));
    const HeelLever lever = heel_lever(foot, tilt * -heel_pivot_in_t_pose(foot), 1.0);
    const glm::dvec3 hip = lever.ankle_from_pivot + glm::dvec3(0.0, 0.9, 0.0);
    const double rad = heel_rise_rad(lever, hip, 0.5);
    const double flat = elevation(-heel_pivot_in_t_pose(foot));
    EXPECT_LE(elevation(raised(lever, rad)) - flat,
              std::max(kMaxHeelPitch_rad, pitch) + 1e-9);
    if (pitch > kMaxHeelPitch_rad) {
      EXPECT_EQ(rad, 0.0);
    }
  }
}

TEST(RaiseHeel, IsScaledByItsShareAndOffWithoutIt) {
  const FootMap foot = adult_foot(false);
  const glm::dvec3 lever_arm = -heel_pivot_in_t_pose(foot);
  const double whole = heel_lever(foot, lever_arm, 1.0).max_rad;
  EXPECT_NEAR(heel_lever(foot, lever_arm, 0.3).max_rad, 0.3 * whole, 1e-15);
  const HeelLever none = heel_lever(foot, lever_arm, 0.0);
  EXPECT_EQ(heel_rise_rad(none, {0.0, 2.0, 0.0}, 0.5), 0.0);
}

}  // namespace
}  // namespace marey::retarget
