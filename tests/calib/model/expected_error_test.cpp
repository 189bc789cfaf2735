// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/expected_error.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::ring_of_cameras;
using marey::testing::webcam_at;

/// Two undistorted cameras a metre apart that look along -Z at a point 2 m away.
std::vector<Camera> stereo_pair() {
  std::vector<Camera> cameras{webcam_at("left", {-0.5, 1.0, 2.0}, {-0.5, 1.0, 0.0}),
                              webcam_at("right", {0.5, 1.0, 2.0}, {0.5, 1.0, 0.0})};
  for (Camera& camera : cameras) camera.intrinsics.distortion = {};
  return cameras;
}

constexpr CameraId kBoth[] = {CameraId{0}, CameraId{1}};

TEST(PointCovariance, IsThatOfAStereoPair) {
  const auto cameras = stereo_pair();
  const auto found = point_covariance(cameras, kBoth, nullptr, {0.0, 1.0, 0.0}, 0.5);
  ASSERT_TRUE(found);
  // There a pixel is 2 m / 900 px wide. Both cameras measure the height and the two
  // directions perpendicular to their rays, which are inclined by 14 degrees: the sum
  // determines x, the difference the depth.
  const double pixel_m = 0.5 * 2.0 / 900.0;
  const double lean = 0.25;  // x over z
  EXPECT_NEAR(std::sqrt((*found)[0][0]), pixel_m / std::sqrt(2.0), 1e-7);
  EXPECT_NEAR(std::sqrt((*found)[2][2]), pixel_m / (lean * std::sqrt(2.0)), 1e-6);
  EXPECT_NEAR((*found)[0][2], 0.0, 1e-12);
}

TEST(PointCovariance, MovesWithACommonShiftOfAllCameras) {
  // All centres have a common error of a millimetre along x; every point has the same
  // error.
  const auto cameras = stereo_pair();
  RigCovariance rig_covariance{2, std::vector<double>(4 * 18 * 18, 0.0)};
  const std::size_t x = RigCovariance::kPerCamera - 3;
  for (const std::size_t a : {x, x + RigCovariance::kPerCamera}) {
    for (const std::size_t b : {x, x + RigCovariance::kPerCamera}) {
      rig_covariance.values[a * rig_covariance.size() + b] = 1e-6;
    }
  }
  const auto sure = point_covariance(cameras, kBoth, nullptr, {0.1, 1.2, 0.1}, 0.5);
  const auto uncertain =
      point_covariance(cameras, kBoth, &rig_covariance, {0.1, 1.2, 0.1}, 0.5);
  ASSERT_TRUE(sure && uncertain);
  EXPECT_NEAR((*uncertain)[0][0] - (*sure)[0][0], 1e-6, 1e-12);
  EXPECT_NEAR((*uncertain)[1][1], (*sure)[1][1], 1e-12);
  EXPECT_NEAR((*uncertain)[2][2], (*sure)[2][2], 1e-12);
}

TEST(PointCovariance, DeclinesAPointSeenByOneCamera) {
  const auto cameras = stereo_pair();
  EXPECT_FALSE(
      point_covariance(cameras, std::span(kBoth, 1), nullptr, {0.0, 1.0, 0.0}, 0.5));
  EXPECT_FALSE(point_covariance(cameras, kBoth, nullptr, {0.0, 1.0, 3.0}, 0.5));
}

TEST(PointCovariance, DeclinesParallelRays) {
  auto cameras = stereo_pair();
  cameras[1] = cameras[0];
  EXPECT_FALSE(point_covariance(cameras, kBoth, nullptr, {0.0, 1.0, 0.0}, 0.5));
}

TEST(CamerasThatSee, LeaveOutThoseWhoseImageThePointMisses) {
  const auto cameras = ring_of_cameras();
  EXPECT_EQ(cameras_that_see(cameras, {0.0, 1.0, 0.0}).size(), 4U);
  // Above the first camera.
  const auto seen_by = cameras_that_see(cameras, {0.4, 2.6, 3.2});
  EXPECT_TRUE(seen_by.empty() || seen_by[0] != CameraId{0});
}

TEST(ErrorMap, IsSmallBetweenTheCameras) {
  const auto cameras = ring_of_cameras();
  const auto map = error_map(cameras, nullptr, {{-1, 0, -1}, {1, 0, 1}, 0.5, {1.0}}, 0.3);
  ASSERT_EQ(map.size(), 25U);
  const ErrorMapPlace& middle = map[12];
  EXPECT_LT(glm::distance(middle.p_in_world, {0.0, 1.0, 0.0}), 1e-12);
  ASSERT_TRUE(middle.error_m);
  EXPECT_EQ(middle.seen_by, 4);
  // 0.3 px of 3.4 m / 900 px, times the root of 3 coordinates, shared by four cameras.
  EXPECT_NEAR(*middle.error_m, 1e-3, 0.3e-3);
  for (const ErrorMapPlace& place : map) {
    if (!place.error_m) continue;
    EXPECT_GE(*place.error_m, 0.8 * *middle.error_m);
  }
}

TEST(ErrorMapGrid, CountsBothEndsOfASide) {
  // 0.3 / 0.1 is less than 3 in doubles.
  const ErrorMapGrid grid{{0.0, 0.0, 1.0}, {0.3, 0.0, 1.95}, 0.1, {1.0}};
  EXPECT_EQ(grid.columns(), 4);
  EXPECT_EQ(grid.rows(), 10);
  EXPECT_EQ(error_map({}, nullptr, grid, 0.1).size(), 40U);
}

}  // namespace
}  // namespace marey::calib
