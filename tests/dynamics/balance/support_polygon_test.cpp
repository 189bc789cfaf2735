// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/support_polygon.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

const SupportPolygon kUnitSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST(SupportPolygon, DistancesOfASquareAreExact) {
  EXPECT_NEAR(*distance_outside(kUnitSquare, {0.5, 0.5}), -0.5, 1e-12);
  EXPECT_NEAR(*distance_outside(kUnitSquare, {0.9, 0.5}), -0.1, 1e-12);
  EXPECT_NEAR(*distance_outside(kUnitSquare, {1.3, 0.5}), 0.3, 1e-12);
  EXPECT_NEAR(*distance_outside(kUnitSquare, {1.3, 1.4}), 0.5, 1e-12);
  EXPECT_NEAR(*distance_outside(kUnitSquare, {1.0, 0.2}), 0.0, 1e-12);
}

TEST(SupportPolygon, TheOrderOfCornersDoesNotMatter) {
  SupportPolygon reversed = kUnitSquare;
  std::reverse(reversed.begin(), reversed.end());
  testing::Dice dice(3);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 p(dice.between(-1, 2), dice.between(-1, 2));
    EXPECT_NEAR(*distance_outside(kUnitSquare, p), *distance_outside(reversed, p), 1e-12);
  }
}

TEST(SupportPolygon, PointsAndLinesHaveNoInside) {
  EXPECT_FALSE(distance_outside({}, {0, 0}));
  EXPECT_NEAR(*distance_outside(SupportPolygon{{1, 1}}, {1, 3}), 2.0, 1e-12);
  EXPECT_NEAR(*distance_outside(SupportPolygon{{0, 0}, {2, 0}}, {1, 0.5}), 0.5, 1e-12);
  EXPECT_GE(*distance_outside(SupportPolygon{{0, 0}, {1, 0}, {2, 0}}, {3, 0}), 1.0);
}

TEST(SupportPolygon, PointsAreMovedInside) {
  testing::Dice dice(5);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 p(dice.between(-1, 2), dice.between(-1, 2));
    const glm::dvec2 q = moved_inside(kUnitSquare, p, 0.05);
    EXPECT_LT(*distance_outside(kUnitSquare, q), 0.0);
    if (*distance_outside(kUnitSquare, p) < -0.05) {
      EXPECT_EQ(q, p);
    }
  }
  EXPECT_EQ(moved_inside({}, {3, 4}, 0.05), glm::dvec2(3, 4));
}

TEST(SupportPolygon, FiguresCountLoadedSupportedAndInsideFrames) {
  std::vector<GroundReaction> reactions(4);
  reactions[0].zmp_xz_m = glm::dvec2(0.5, 0.5);
  reactions[1].zmp_xz_m = glm::dvec2(1.25, 0.5);
  reactions[2].zmp_xz_m = glm::dvec2(9.0, 9.0);
  const std::vector<SupportPolygon> supports{kUnitSquare, kUnitSquare, {}, kUnitSquare};
  const ZmpFigures figures = zmp_figures(reactions, supports);
  EXPECT_EQ(figures.loaded_frames, 3);
  EXPECT_EQ(figures.supported_frames, 2);
  EXPECT_EQ(figures.inside_frames, 1);
  EXPECT_NEAR(figures.worst_outside_m, 0.25, 1e-12);
  EXPECT_EQ(figures.worst_frame, 1);
  EXPECT_NEAR(figures.inside_share(), 0.5, 1e-12);
}

}  // namespace
}  // namespace marey::dynamics
