// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/plan_rig.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"
#include "tests/support/truth/fit_tag_pose.h"

namespace marey::calib {
namespace {

using marey::testing::Dice;
using marey::testing::TagView;
using marey::testing::webcam_at;

double constant_sigma_px(double /*side_px*/) {
  return 0.1;
}

/// An upright tag that faces `angle_rad`: 0 is +Z, positive towards +X.
RigidTransform tag_facing(double angle_rad, const glm::dvec3& p_in_world) {
  const glm::dquat upright = rotation_from_vector({std::numbers::pi, 0.0, 0.0});
  return {rotation_from_vector({0.0, angle_rad, 0.0}) * upright, p_in_world};
}

/// Tags that two of these cameras can read at once.
PlanOptions large_tags() {
  PlanOptions options;
  options.tag_size_m = 0.12;
  return options;
}

/// Four webcams at the corners of a square around the origin.
std::vector<Camera> square_of_cameras(double distance_m) {
  std::vector<Camera> cameras;
  for (const double x : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      cameras.push_back(webcam_at("cam" + std::to_string(cameras.size()),
                                  {x * distance_m, 1.5, z * distance_m},
                                  {0.0, 1.0, 0.0}));
      cameras.back().intrinsics.distortion = {};
    }
  }
  return cameras;
}

TEST(ExpectTag, FindsNoCameraForATagFacingUpTooSmallOrOutside) {
  const auto cameras = square_of_cameras(2.5);
  const PlanOptions options;
  const RigidTransform middle = tag_facing(0.3, {0.0, 1.0, 0.0});
  EXPECT_FALSE(
      expect_tag(cameras, nullptr, middle, constant_sigma_px, options).seen_by.empty());
  const RigidTransform outside = tag_facing(0.3, {0.0, 9.0, 0.0});
  PlanOptions tiny = options;
  tiny.tag_size_m = 0.02;  // 5 px at 3.6 m.
  for (const ExpectedTag& tag :
       {expect_tag(cameras, nullptr, outside, constant_sigma_px, options),
        expect_tag(cameras, nullptr, middle, constant_sigma_px, tiny),
        expect_tag({}, nullptr, middle, constant_sigma_px, options)}) {
    EXPECT_TRUE(tag.seen_by.empty());
    EXPECT_EQ(tag.side_px, 0.0);
    EXPECT_FALSE(tag.centre_error_m || tag.joint_error_m);
  }
  const RigidTransform lying{rotation_from_vector({0.5 * std::numbers::pi, 0.0, 0.0}),
                             {0.0, 1.0, 0.0}};
  // Its normal is 82 degrees from every camera, which stand half a metre above it.
  EXPECT_TRUE(
      expect_tag(cameras, nullptr, lying, constant_sigma_px, options).seen_by.empty());
}

TEST(ExpectTag, IsNotPlacedByOneCameraAlone) {
  auto cameras = square_of_cameras(2.5);
  cameras.resize(1);
  const RigidTransform facing_it = tag_facing(-0.75 * std::numbers::pi, {0.0, 1.0, 0.0});
  const ExpectedTag tag = expect_tag(cameras, nullptr, facing_it, constant_sigma_px, {});
  ASSERT_EQ(tag.seen_by.size(), 1U);
  EXPECT_FALSE(tag.centre_error_m);
  // 80 mm at 3.57 m, 900 px: 20.2 px from the front.
  EXPECT_NEAR(tag.side_px, 20.0, 0.5);
}

TEST(ExpectTag, ErrsMoreFartherAway) {
  double last_m = 0.0;
  for (const double distance_m : {1.5, 2.0, 2.5, 2.8}) {
    const auto cameras = square_of_cameras(distance_m);
    const ExpectedTag tag = expect_tag(cameras,
                                       nullptr,
                                       tag_facing(0.0, {0.0, 1.0, 0.0}),
                                       constant_sigma_px,
                                       large_tags());
    ASSERT_TRUE(tag.centre_error_m) << distance_m;
    EXPECT_GT(*tag.centre_error_m, last_m);
    EXPECT_GT(*tag.joint_error_m, *tag.centre_error_m);
    last_m = *tag.centre_error_m;
  }
}

TEST(ExpectTag, ErrsAsFitsToNoisyCornersDo) {
  // 3000 draws determine a root mean square within 2 %; the rest is for nonlinearity.
  constexpr int kDraws = 3000;
  const auto cameras = square_of_cameras(2.0);
  const PlanOptions options = large_tags();
  const RigidTransform truth = tag_facing(0.1, {0.2, 0.9, 0.1});
  const ExpectedTag expected =
      expect_tag(cameras, nullptr, truth, constant_sigma_px, options);
  ASSERT_GE(expected.seen_by.size(), 2U);
  Dice dice(7);
  double centre_m2 = 0.0;
  double joint_m2 = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<TagView> views;
    for (const CameraId id : expected.seen_by) {
      TagView view{&cameras[index(id)], {}, 0.1};
      for (int c = 0; c < 4; ++c) {
        view.corners_px[static_cast<std::size_t>(c)] =
            *project(*view.camera, truth * corner_in_tag(c, options.tag_size_m)) +
            glm::dvec2(dice.noise(0.1), dice.noise(0.1));
      }
      views.push_back(view);
    }
    const RigidTransform found = fit_tag_pose(views, options.tag_size_m, truth);
    const glm::dvec3 lever = options.lever_m * dice.direction();
    const glm::dvec3 off = found.translation - truth.translation;
    const glm::dvec3 joint_off = found * lever - truth * lever;
    centre_m2 += glm::dot(off, off) / kDraws;
    joint_m2 += glm::dot(joint_off, joint_off) / kDraws;
  }
  EXPECT_NEAR(std::sqrt(centre_m2) / *expected.centre_error_m, 1.0, 0.15);
  EXPECT_NEAR(std::sqrt(joint_m2) / *expected.joint_error_m, 1.0, 0.15);
}

TEST(ExpectTag, IncludesTheUncertaintyOfCameras) {
  const auto cameras = square_of_cameras(2.5);
  const RigidTransform pose = tag_facing(0.0, {0.0, 1.0, 0.0});
  RigCovariance rig_covariance{4, std::vector<double>(16 * 18 * 18, 0.0)};
  // All centres have a common error of a millimetre along each axis; every tag has the
  // same error.
  for (std::size_t axis = 15; axis < 18; ++axis) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        rig_covariance.values[(18 * a + axis) * rig_covariance.size() + 18 * b + axis] =
            1e-6;
      }
    }
  }
  const ExpectedTag sure =
      expect_tag(cameras, nullptr, pose, constant_sigma_px, large_tags());
  const ExpectedTag uncertain =
      expect_tag(cameras, &rig_covariance, pose, constant_sigma_px, large_tags());
  ASSERT_TRUE(sure.centre_error_m && uncertain.centre_error_m);
  EXPECT_NEAR(std::pow(*uncertain.centre_error_m, 2) - std::pow(*sure.centre_error_m, 2),
              3e-6,
              1e-11);
}

TEST(PlanRig, ReturnsASymmetricPlanForASymmetricRig) {
  const auto cameras = square_of_cameras(2.5);
  const ErrorMapGrid grid{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}, 0.5, {0.9}};
  PlanOptions large;
  large.tag_size_m = 0.16;
  const RigPlan plan = plan_rig(cameras, nullptr, grid, constant_sigma_px, large);
  ASSERT_EQ(plan.places.size(), 25U);
  ASSERT_EQ(plan.heights.size(), 1U);
  // Cameras 90 degrees apart with a range of 65 degrees to either side share 40 of these
  // 90, less for tags outside of an image.
  EXPECT_GT(plan.heights[0].measured_share, 0.35);
  EXPECT_LT(plan.heights[0].measured_share, 0.5);
  EXPECT_GE(plan.heights[0].seen_share, plan.heights[0].measured_share);
  for (std::size_t i = 0; i < 25; ++i) {
    const PlannedPlace& place = plan.places[i];
    const PlannedPlace& opposite = plan.places[24 - i];
    const PlannedPlace& mirrored = plan.places[i / 5 * 5 + 4 - i % 5];
    ASSERT_TRUE(place.centre_error_m && opposite.centre_error_m);
    EXPECT_NEAR(*place.centre_error_m, *opposite.centre_error_m, 1e-9);
    EXPECT_NEAR(*place.joint_error_m, *mirrored.joint_error_m, 1e-9);
    EXPECT_EQ(place.measured_share, mirrored.measured_share);
  }
}

TEST(PlanRig, ReportsNoErrorsWhereFewerThanTwoCamerasSee) {
  const std::vector<Camera> one{square_of_cameras(2.5)[0]};
  const ErrorMapGrid grid{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}, 1.0, {0.1, 1.4}};
  const RigPlan plan = plan_rig(one, nullptr, grid, constant_sigma_px, {});
  ASSERT_EQ(plan.heights.size(), 2U);
  EXPECT_GT(plan.heights[1].seen_share, 0.1);
  EXPECT_EQ(plan.heights[1].measured_share, 0.0);
  EXPECT_FALSE(plan.heights[1].centre_error_m || plan.heights[1].joint_error_m);
}

TEST(GridBefore, LiesWhereTheCamerasLook) {
  std::vector<Camera> cameras{webcam_at("a", {3.0, 2.0, 1.0}, {1.0, 1.0, -1.0}),
                              webcam_at("b", {-1.0, 2.0, 1.0}, {1.0, 1.0, -1.0})};
  const ErrorMapGrid grid = grid_before(cameras);
  const glm::dvec3 middle = 0.5 * (grid.min_in_world + grid.max_in_world);
  EXPECT_LT(glm::distance(middle, {1.0, 0.0, -1.0}), 1e-9);
  cameras[1] = cameras[0];  // Parallel axes: below the cameras.
  const ErrorMapGrid below = grid_before(cameras);
  EXPECT_NEAR(0.5 * (below.min_in_world.x + below.max_in_world.x), 3.0, 1e-9);
}

}  // namespace
}  // namespace marey::calib
