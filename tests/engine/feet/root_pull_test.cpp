// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/root_pull.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::engine {
namespace {

TEST(RootPull, BringsTheRootToTheFeetWithoutPassingThem) {
  RootPull pull;
  const glm::dvec2 feet_m(0.1, -0.05);
  glm::dvec2 root_m(0.0);
  double away_m = glm::length(feet_m);
  for (int i = 0; i < 72; ++i) {
    root_m += pull.step(feet_m - root_m, 1.0 / 120.0);
    const double now_m = glm::distance(root_m, feet_m);
    EXPECT_LE(now_m, away_m + 1e-12);
    away_m = now_m;
  }
  EXPECT_LT(away_m, 1e-4);
}

TEST(RootPull, DoesNothingWithoutFeet) {
  RootPull pull;
  EXPECT_EQ(pull.step(glm::dvec2(0.0), 1.0 / 60.0), glm::dvec2(0.0));
}

}  // namespace
}  // namespace marey::engine
