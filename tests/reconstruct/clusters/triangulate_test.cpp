// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/triangulate.h"

#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Dice;
using marey::testing::ring_of_cameras;
using marey::testing::webcam_at;

PointView see(const Camera& camera, const glm::dvec3& p_in_world) {
  const auto pixel_px = project(camera, p_in_world);
  EXPECT_TRUE(pixel_px);
  return {&camera, pixel_px.value_or(glm::dvec2(0.0))};
}

// Tests the inverse of project() on exact pixels, without noise.
TEST(Triangulate, RecoversAPointSeenExactly) {
  const auto cameras = ring_of_cameras();
  for (const glm::dvec3& truth :
       {glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0.2, -0.5), glm::dvec3(-0.4, 1.8, 0.3)}) {
    for (std::size_t count = 2; count <= cameras.size(); ++count) {
      std::vector<PointView> views;
      for (std::size_t c = 0; c < count; ++c) views.push_back(see(cameras[c], truth));
      const auto point = triangulate(views);
      ASSERT_TRUE(point);
      // Rays are accurate to 1e-9 px: 4e-12 m at three metres.
      EXPECT_LT(glm::distance(point->p_in_world, truth), 1e-10);
      EXPECT_LT(point->rms_px, 1e-7);
    }
  }
}

TEST(Triangulate, IsAsGoodAsItsPixels) {
  const auto cameras = ring_of_cameras();
  const glm::dvec3 truth(0.1, 1.2, -0.2);
  Dice dice(5);
  double sum_m2 = 0.0;
  double sum_px2 = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<PointView> views;
    for (const Camera& camera : cameras) {
      views.push_back(see(camera, truth));
      views.back().pixel_px += glm::dvec2(dice.noise(0.2), dice.noise(0.2));
    }
    const auto point = triangulate(views);
    ASSERT_TRUE(point);
    sum_m2 += glm::dot(point->p_in_world - truth, point->p_in_world - truth) / 3.0;
    sum_px2 += point->rms_px * point->rms_px;
  }
  // 0.2 px at 3.5 m and 900 px is 0.8 mm across each ray. Eight such numbers determine
  // three coordinates: 0.8 sqrt(3 / 8) = 0.48 mm each, and leave 5/8 of the variance as
  // misfit.
  EXPECT_NEAR(std::sqrt(sum_m2 / kRuns), 0.00048, 0.00005);
  EXPECT_NEAR(std::sqrt(sum_px2 / kRuns), 0.2 * std::sqrt(2.0 * 5.0 / 8.0), 0.02);
}

TEST(Triangulate, ReportsTheDistanceOfTheRays) {
  const auto cameras = ring_of_cameras();
  std::array<PointView, 2> views{see(cameras[0], {0, 1, 0}),
                                 see(cameras[1], {0, 1.1, 0})};
  const auto point = triangulate(views);
  ASSERT_TRUE(point);
  // Ten centimetres are 26 px at 3.4 m: each ray misses the middle by half of them.
  EXPECT_NEAR(point->rms_px, 12.0, 2.0);
}

TEST(Triangulate, DeclinesRaysNearlyParallel) {
  const Camera one = webcam_at("one", {0.0, 1.0, 3.0}, {0, 1, 0});
  const Camera twin = webcam_at("twin", {0.05, 1.0, 3.0}, {0, 1, 0});
  const glm::dvec3 p(0.0, 1.0, 0.0);
  // 0.05 m over 3 m is 0.017 rad; the limit is 0.03.
  EXPECT_FALSE(triangulate(std::array{see(one, p), see(twin, p)}));
  EXPECT_TRUE(triangulate(std::array{see(one, p), see(twin, p)}, {0.01}));
}

TEST(Triangulate, DeclinesASingleView) {
  const auto cameras = ring_of_cameras();
  EXPECT_FALSE(triangulate(std::array{see(cameras[0], {0, 1, 0})}));
}

TEST(Triangulate, DeclinesRaysThatMeetBehindACamera) {
  const Camera left = webcam_at("left", {-0.5, 1.0, 3.0}, {-0.5, 1.0, 0.0});
  const Camera right = webcam_at("right", {0.5, 1.0, 3.0}, {0.5, 1.0, 0.0});
  // Each looks away from the other's side: the rays diverge.
  EXPECT_FALSE(triangulate(
      std::array{PointView{&left, {400.0, 357.0}}, PointView{&right, {900.0, 357.0}}}));
}

TEST(Triangulate, DeclinesAPixelThatNoRayBelongsTo) {
  auto cameras = ring_of_cameras();
  cameras[1].intrinsics.distortion = {-0.3, 0.0, 0.0, 0.0, 0.0};
  std::array<PointView, 2> views{see(cameras[0], {0, 1, 0}), see(cameras[1], {0, 1, 0})};
  views[1].pixel_px = {3000.0, 357.0};
  EXPECT_FALSE(triangulate(views));
}

}  // namespace
}  // namespace marey::reconstruct
