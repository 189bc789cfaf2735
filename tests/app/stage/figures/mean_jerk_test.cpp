// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/mean_jerk.h"

#include <gtest/gtest.h>

#include "app/stage/figures/worst_value.h"

namespace marey::app {
namespace {

TEST(MeanJerk, ACubicHasItsThirdDerivative) {
  MeanJerk jerk(1.0 / 60);
  for (int i = 0; i < 100; ++i) {
    const double t = i / 60.0;
    const std::vector<glm::dvec3> points{{t * t * t, 2.0 * t * t, 1.0},
                                         {0.0, -2.0 * t * t * t, t}};
    jerk.add(points);
  }
  EXPECT_EQ(jerk.count(), 2U * 97U);
  EXPECT_NEAR(jerk.mean_m_s3(), (6.0 + 12.0) / 2.0, 1e-6);
}

TEST(MeanJerk, AnInterruptionIsNoJerk) {
  MeanJerk jerk(0.01);
  for (int i = 0; i < 20; ++i) {
    if (i == 10) jerk.interrupt();
    const std::vector<glm::dvec3> points{{i < 10 ? 0.0 : 5.0, 0.01 * i, 0.0}};
    jerk.add(points);
  }
  EXPECT_EQ(jerk.count(), 14U);
  EXPECT_NEAR(jerk.mean_m_s3(), 0.0, 1e-6);
}

TEST(WorstValue, KeepsTheValueAndItsTime) {
  WorstValue largest;
  WorstValue smallest;
  for (const auto& [value, time_s] : {std::pair{2.0, 0.1}, {5.0, 0.2}, {-3.0, 0.3}}) {
    largest.add(value, time_s);
    smallest.add_smallest(value, time_s);
  }
  EXPECT_EQ(largest.value, 5.0);
  EXPECT_EQ(largest.time_s, 0.2);
  EXPECT_EQ(smallest.value, -3.0);
  EXPECT_EQ(smallest.time_s, 0.3);
  EXPECT_EQ(smallest.count, 3U);
}

}  // namespace
}  // namespace marey::app
