// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/board.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey {
namespace {

// 2 rows of 3 tags, 80 mm and 20 mm apart, ids 10 to 15.
constexpr AprilGrid kSmall{2, 3, 0.08, 0.02, 10, 0.0};

void expect_corner(int id, int corner, const glm::dvec3& expected) {
  const auto p = kSmall.corner_in_board(TagId{id}, corner);
  ASSERT_TRUE(p);
  EXPECT_LT(glm::distance(*p, expected), 1e-15) << "tag " << id << " corner " << corner;
}

TEST(AprilGrid, StartsAtTheBottomLeftCornerOfItsFirstTag) {
  expect_corner(10, 0, {0.0, 0.0, 0.0});
  expect_corner(10, 1, {0.08, 0.0, 0.0});
  expect_corner(10, 2, {0.08, 0.08, 0.0});
  expect_corner(10, 3, {0.0, 0.08, 0.0});
}

TEST(AprilGrid, CountsAlongXThenUpY) {
  expect_corner(12, 0, {0.2, 0.0, 0.0});
  expect_corner(13, 0, {0.0, 0.1, 0.0});
  expect_corner(15, 2, {0.28, 0.18, 0.0});
}

TEST(AprilGrid, DoesNotKnowTagsBeforeItsFirstOrAfterItsLast) {
  EXPECT_FALSE(kSmall.corner_in_board(TagId{9}, 0));
  EXPECT_FALSE(kSmall.corner_in_board(TagId{16}, 0));
  EXPECT_FALSE(kSmall.contains(TagId{-1}));
  EXPECT_TRUE(kSmall.contains(TagId{15}));
}

TEST(AprilGridDeathTest, HasFourCornersATag) {
  EXPECT_DEATH((void)kSmall.corner_in_board(TagId{10}, 4), "contract broken");
}

}  // namespace
}  // namespace marey
