// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/detection.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey {
namespace {

/// Opposite edges moved together, as lens and detector do.
std::array<glm::dvec2, 4> shrunk(const std::array<glm::dvec2, 4>& corners_px,
                                 const TagShrinkage& shrinkage) {
  std::array<std::array<double, 2>, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) corners[i] = {corners_px[i].x, corners_px[i].y};
  move_edges(corners, [&](double apart_px) {
    return apart_px - (shrinkage.offset_px + shrinkage.slope * apart_px);
  });
  std::array<glm::dvec2, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = {corners[i][0], corners[i][1]};
  return out;
}

TEST(CornerInTag, GoesRoundFromTheBottomLeftOfTheUprightTag) {
  // The tag frame's y points down: the bottom has the positive y.
  EXPECT_EQ(corner_in_tag(0, 0.1), glm::dvec3(-0.05, +0.05, 0.0));
  EXPECT_EQ(corner_in_tag(1, 0.1), glm::dvec3(+0.05, +0.05, 0.0));
  EXPECT_EQ(corner_in_tag(2, 0.1), glm::dvec3(+0.05, -0.05, 0.0));
  EXPECT_EQ(corner_in_tag(3, 0.1), glm::dvec3(-0.05, -0.05, 0.0));
}

TEST(Unshrunk, GrowsAnUprightSquareByOffsetAndSlope) {
  const std::array<glm::dvec2, 4> seen_px{{{10, 50}, {50, 50}, {50, 10}, {10, 10}}};
  // 40 seen = s - (0.8 + 0.02 s), so s = 41.632...: half of the rest on each side.
  const auto true_px = unshrunk(seen_px, {0.8, 0.02});
  const double grown_px = 0.5 * ((40.0 + 0.8) / 0.98 - 40.0);
  EXPECT_NEAR(true_px[0].x, 10.0 - grown_px, 1e-12);
  EXPECT_NEAR(true_px[0].y, 50.0 + grown_px, 1e-12);
  EXPECT_NEAR(true_px[2].x, 50.0 + grown_px, 1e-12);
  EXPECT_NEAR(true_px[2].y, 10.0 - grown_px, 1e-12);
}

TEST(Unshrunk, UndoesShrinkageOfAnyQuadrilateral) {
  // Turned, sheared and in perspective: the correction is first order, its inverse exact.
  const std::array<glm::dvec2, 4> true_px{
      {{100.0, 140.0}, {151.0, 128.0}, {139.0, 83.0}, {104.0, 88.0}}};
  const TagShrinkage shrinkage{0.7, 0.015};
  const auto back_px = unshrunk(shrunk(true_px, shrinkage), shrinkage);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(glm::distance(back_px[i], true_px[i]), 1e-11 /* px; rounding */);
  }
}

TEST(Unshrunk, LeavesCornersAloneWithoutShrinkage) {
  const std::array<glm::dvec2, 4> seen_px{
      {{100.0, 140.0}, {151.0, 128.0}, {139.0, 83.0}, {104.0, 88.0}}};
  const auto same_px = unshrunk(seen_px, {});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(glm::distance(same_px[i], seen_px[i]), 1e-11 /* px; rounding */);
  }
}

// A tag seen edge-on has no sides to move apart; nothing may come of dividing by its
// area.
TEST(Unshrunk, LeavesCornersWithoutAnAreaAlone) {
  const std::array<glm::dvec2, 4> edge_on_px{{{10, 50}, {50, 50}, {50, 50}, {10, 50}}};
  const std::array<glm::dvec2, 4> point_px{{{10, 50}, {10, 50}, {10, 50}, {10, 50}}};
  EXPECT_EQ(unshrunk(edge_on_px, {0.8, 0.02}), edge_on_px);
  EXPECT_EQ(unshrunk(point_px, {0.8, 0.02}), point_px);
}

TEST(CornerInTagDeathTest, HasFourCorners) {
  EXPECT_DEATH((void)corner_in_tag(4, 0.1), "contract broken");
  EXPECT_DEATH((void)corner_in_tag(-1, 0.1), "contract broken");
}

}  // namespace
}  // namespace marey
