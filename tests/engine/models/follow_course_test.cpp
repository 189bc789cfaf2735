// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/follow_course.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/models/made_walker.h"

namespace marey::engine {
namespace {

constexpr double kStep_s = 1.0 / 60.0;

TEST(FollowCourse, StaysAtATargetThatRests) {
  FollowCourse course;
  ASSERT_TRUE(course.start({0.1, 1.2, -0.3}, glm::dvec3{0.0}));
  for (int i = 0; i < 100; ++i) course.step({0.1, 1.2, -0.3}, kStep_s);
  EXPECT_LT(course.state().behind_m, 1e-12);
}

TEST(FollowCourse, FollowsAConstantVelocityWithoutDelay) {
  FollowCourse course;
  ASSERT_TRUE(course.start(glm::dvec3{0.0}, glm::dvec3{0.0}));
  const glm::dvec3 velocity{0.6, 0.2, -0.4};
  for (int i = 1; i <= 90; ++i) course.step(velocity * (i * kStep_s), kStep_s);
  EXPECT_LT(course.state().behind_m, 1e-4 /* m */);
}

TEST(FollowCourse, ReachesAJumpWithinTheTimeThatItsBoundsNeed) {
  FollowCourse course;
  ASSERT_TRUE(course.start(glm::dvec3{0.0}, glm::dvec3{0.0}));
  const glm::dvec3 target{0.4, 0.0, 0.0};
  double arrived_s = 9.0;
  double farthest_m = 0.0;
  for (int i = 1; i <= 120; ++i) {
    const FollowState& state = course.step(target, kStep_s);
    farthest_m = std::max(farthest_m, state.p_in_world.x);
    if (state.behind_m < 0.01 && arrived_s > 8.0) arrived_s = i * kStep_s;
  }
  // From rest to rest in 2 sqrt(d / a) = 0.25 s with a bounded acceleration alone.
  EXPECT_LT(arrived_s, 0.55);
  EXPECT_LT(farthest_m, 0.41 /* m */);
  EXPECT_LT(course.state().behind_m, 1e-4);
}

TEST(FollowCourse, KeepsItsBoundsWhateverTheTargetDoes) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    MadeNumbers numbers(seed);
    FollowSettings settings;
    FollowCourse course;
    ASSERT_TRUE(course.start(glm::dvec3{0.0}, glm::dvec3{0.0}, settings));
    glm::dvec3 target{0.0}, before{0.0}, velocity{0.0}, place{0.0};
    for (int i = 0; i < 300; ++i) {
      if (numbers.next(0.0, 1.0) < 0.05) {
        target = {numbers.next(-1, 1), numbers.next(-1, 1), numbers.next(-1, 1)};
      }
      const bool is_lost = numbers.next(0.0, 1.0) < 0.02;
      const double nan = std::numeric_limits<double>::quiet_NaN();
      const FollowState& state =
          course.step(is_lost ? glm::dvec3{nan, 0.0, 0.0} : target, kStep_s);
      const glm::dvec3 a = state.acceleration_m_s2;
      EXPECT_LE(glm::length(a), settings.max_acceleration_m_s2 * (1.0 + 1e-9));
      EXPECT_LE(glm::length(a - before), settings.max_jerk_m_s3 * kStep_s * (1.0 + 1e-9));
      // Place and velocity belong together: no jump in either.
      EXPECT_LT(glm::length(state.velocity_m_s - velocity - 0.5 * (a + before) * kStep_s),
                0.05);
      EXPECT_LT(glm::length(state.p_in_world - place - velocity * kStep_s), 0.01);
      before = a;
      velocity = state.velocity_m_s;
      place = state.p_in_world;
    }
  }
}

TEST(FollowCourse, StopsWhenTheTargetIsLost) {
  FollowCourse course;
  ASSERT_TRUE(course.start(glm::dvec3{0.0}, {1.0, 0.0, 0.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 90; ++i) course.step({nan, nan, nan}, kStep_s);
  EXPECT_LT(glm::length(course.state().velocity_m_s), 1e-3 /* m/s */);
  EXPECT_LT(course.state().p_in_world.x, 0.3 /* m */);
}

TEST(FollowCourse, RefusesNumbersThatAreNotFinite) {
  FollowCourse course;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(course.start({nan, 0.0, 0.0}, glm::dvec3{0.0}));
  EXPECT_FALSE(course.start(glm::dvec3{0.0}, {0.0, nan, 0.0}));
  FollowSettings settings;
  settings.max_acceleration_m_s2 = 0.0;
  EXPECT_FALSE(course.start(glm::dvec3{0.0}, glm::dvec3{0.0}, settings));
}

}  // namespace
}  // namespace marey::engine
