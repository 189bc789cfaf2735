// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/estimate_clocks.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::webcam_at;

constexpr double kHz = 30.0;
constexpr double kSize_m = 0.15;
const std::map<TagId, double> kSizes{{TagId{3}, kSize_m}, {TagId{7}, kSize_m}};

std::vector<Camera> three_late_cameras() {
  return {webcam_at("cam0", {-1.2, 1.2, 2.2}, {0.0, 1.0, 0.0}),
          webcam_at("cam1", {0.1, 1.6, 2.4}, {0.0, 1.0, 0.0}),
          webcam_at("cam2", {1.3, 1.0, 2.1}, {0.0, 1.0, 0.0})};
}

RigidTransform world_from_tag(double time_s, double phase) {
  // The printed face (minus z) looks towards the cameras.
  return {rotation_from_vector({0.3 * std::sin(3.0 * time_s + phase), 3.14159, 0.0}) *
              rotation_from_vector({0.0, 0.0, 0.5 * std::sin(2.0 * time_s)}),
          {0.4 * std::sin(2.5 * time_s + phase),
           1.0 + 0.3 * std::cos(3.1 * time_s + phase),
           0.2 * std::sin(1.9 * time_s)}};
}

std::vector<CameraDetections> film_late(const std::array<double, 3>& late_s,
                                        double noise_px,
                                        double speed = 1.0) {
  const auto cameras = three_late_cameras();
  auto out = marey::testing::unseeing(cameras, 90, kHz, "motion");
  marey::testing::Dice dice(11);
  for (std::size_t c = 0; c < 3; ++c) {
    for (FrameDetections& frame : out[c].frames) {
      const double time_s = speed * (frame.frame / kHz + late_s[c]);
      for (const auto& [id, size_m] : kSizes) {
        const auto tag = marey::testing::see_tag(
            cameras[c], world_from_tag(time_s, number(id)), id, size_m, 1.4);
        if (!tag) continue;
        frame.tags.push_back(
            marey::testing::disturbed(*tag, {noise_px, {}, 0.0, 0.2}, dice));
      }
    }
  }
  return out;
}

TEST(EstimateClocks, FindsOffsetsBetweenFrames) {
  const auto clocks = estimate_clocks(
      three_late_cameras(), film_late({0.0, 0.0073, -0.0111}, 0.0), kSizes);
  ASSERT_TRUE(clocks);
  EXPECT_EQ((*clocks)[0].offset_s, 0.0);
  // The remaining error is that of a spline of 1/30 s for a sine of 3 rad/s.
  EXPECT_NEAR((*clocks)[1].offset_s, 0.0073, 1e-4);
  EXPECT_NEAR((*clocks)[2].offset_s, -0.0111, 1e-4);
}

TEST(EstimateClocks, FindsOffsetsOfManyFramesUnderNoise) {
  const auto clocks = estimate_clocks(
      three_late_cameras(), film_late({0.0, 0.2473, -0.1311}, 0.2), kSizes);
  ASSERT_TRUE(clocks);
  EXPECT_NEAR((*clocks)[1].offset_s, 0.2473, 1e-3);
  EXPECT_NEAR((*clocks)[2].offset_s, -0.1311, 1e-3);
  EXPECT_LT(std::abs((*clocks)[1].offset_s - 0.2473), 3.0 * (*clocks)[1].offset_sigma_s);
}

TEST(EstimateClocks, ReportsALargeUncertaintyForTagsAtRest) {
  const auto still =
      estimate_clocks(three_late_cameras(), film_late({0.0, 0.0, 0.0}, 0.2, 0.0), kSizes);
  const auto moving =
      estimate_clocks(three_late_cameras(), film_late({0.0, 0.0, 0.0}, 0.2), kSizes);
  ASSERT_TRUE(still && moving);
  // Noise is equivalent to a small motion.
  EXPECT_GT((*still)[1].offset_sigma_s, 10.0 * (*moving)[1].offset_sigma_s);
}

TEST(EstimateClocks, DeclinesTagsWithoutASharedView) {
  auto detections = film_late({0.0, 0.0, 0.0}, 0.0);
  for (std::size_t c = 1; c < 3; ++c) {
    for (FrameDetections& frame : detections[c].frames) frame.tags.clear();
  }
  EXPECT_FALSE(estimate_clocks(three_late_cameras(), detections, kSizes));
}

}  // namespace
}  // namespace marey::calib
