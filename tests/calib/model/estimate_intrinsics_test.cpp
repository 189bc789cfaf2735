// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/estimate_intrinsics.h"

#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::Disturbance;
using marey::testing::ring_of_cameras;
using marey::testing::wave_board;

const AprilGrid kGaplessBoard{6, 6, 0.1, 0.03, 0, 0.0};

/// A camera at the origin that looks along z; boards are placed in front of it.
BoardView view_of(const Intrinsics& k, const RigidTransform& camera_from_board) {
  BoardView view;
  for (int id = 0; id < kGaplessBoard.tag_count(); ++id) {
    for (int c = 0; c < 4; ++c) {
      const glm::dvec3 p = *kGaplessBoard.corner_in_board(TagId{id}, c);
      const auto pixel = project(Camera{{}, k, {}, {}}, camera_from_board * p);
      EXPECT_TRUE(pixel);
      view.corners.push_back({p, *pixel, 0.3});
    }
  }
  return view;
}

/// The board's middle at `distance_m`, tilted by `tilt_rad` from frontal.
RigidTransform before(double distance_m, const glm::dvec3& tilt_rad) {
  const glm::dquat face_the_camera = rotation_from_vector({glm::radians(180.0), 0, 0});
  const glm::dquat turn = rotation_from_vector(tilt_rad) * face_the_camera;
  return {turn, glm::dvec3(0, 0, distance_m) - turn * glm::dvec3(0.375, 0.375, 0)};
}

std::vector<const BoardView*> pointers(const std::vector<BoardView>& views) {
  std::vector<const BoardView*> out;
  for (const BoardView& view : views) out.push_back(&view);
  return out;
}

std::vector<BoardView> tilted_views(const Intrinsics& k) {
  std::vector<BoardView> views;
  for (const glm::dvec3& tilt : {glm::dvec3(0.5, 0, 0),
                                 glm::dvec3(-0.5, 0.1, 0.2),
                                 glm::dvec3(0, 0.6, 0),
                                 glm::dvec3(0.1, -0.6, -0.3),
                                 glm::dvec3(0.4, 0.4, 0)}) {
    views.push_back(view_of(k, before(1.5, tilt)));
  }
  return views;
}

TEST(EstimateIntrinsics, ComesNearTheTruthFromExactViews) {
  Intrinsics k = marey::testing::webcam();
  // Parameters that this first estimate does not solve for have their assumed values.
  k.centre_px = {639.5, 359.5};
  k.distortion = {-0.1, 0.0, 0.0, 0.0, 0.0};
  const auto views = tilted_views(k);
  const auto found = estimate_intrinsics(pointers(views), k.width_px, k.height_px);
  ASSERT_TRUE(found);
  // OpenCV takes pixels as floats: 3e-5 px of 500.
  EXPECT_NEAR(found->focal_px.x, 900.0, 0.01);
  EXPECT_NEAR(found->focal_px.y, 900.0, 0.01);
  EXPECT_NEAR(found->distortion[0], -0.1, 1e-4);
}

TEST(EstimateIntrinsics, IsAFairStartForARealLens) {
  const Intrinsics k = marey::testing::webcam();
  const auto views = tilted_views(k);
  const auto found = estimate_intrinsics(pointers(views), k.width_px, k.height_px);
  ASSERT_TRUE(found);
  // The bundle converges from errors of a few percent.
  EXPECT_NEAR(found->focal_px.x / k.focal_px.x, 1.0, 0.02);
}

TEST(EstimateIntrinsics, DeclinesFewerThanFourViews) {
  const Intrinsics k = marey::testing::webcam();
  auto views = tilted_views(k);
  views.resize(3);
  EXPECT_FALSE(estimate_intrinsics(pointers(views), k.width_px, k.height_px));
}

TEST(EstimateIntrinsics, DoesNotCountViewsOfFewerThanSixTags) {
  const Intrinsics k = marey::testing::webcam();
  auto views = tilted_views(k);
  views.resize(4);
  EXPECT_TRUE(estimate_intrinsics(pointers(views), k.width_px, k.height_px));
  views[2].corners.resize(20);
  EXPECT_FALSE(estimate_intrinsics(pointers(views), k.width_px, k.height_px));
}

TEST(EstimateIntrinsics, DeclinesABoardThatNeverTilts) {
  // In a frontal view, twice the focal length at twice the distance gives the same image.
  const Intrinsics k = marey::testing::webcam();
  std::vector<BoardView> views;
  for (const double distance_m : {1.2, 1.4, 1.6, 1.8, 2.0}) {
    views.push_back(view_of(k, before(distance_m, {0, 0, 0.2 * distance_m})));
  }
  EXPECT_FALSE(estimate_intrinsics(pointers(views), k.width_px, k.height_px));
}

TEST(CameraFromBoard, RecoversAnExactView) {
  const Intrinsics k = marey::testing::webcam();
  for (const glm::dvec3& tilt :
       {glm::dvec3(0.5, 0, 0), glm::dvec3(-0.3, 0.6, 1.0), glm::dvec3(0, 0.9, 0)}) {
    const RigidTransform truth = before(2.0, tilt);
    const auto found = camera_from_board(k, view_of(k, truth));
    ASSERT_TRUE(found);
    // Rays as floats: 6e-8 of half a metre at two metres.
    EXPECT_LT(glm::distance(found->translation, truth.translation), 1e-5 /* m */);
    EXPECT_LT(
        glm::length(rotation_vector(glm::conjugate(found->rotation) * truth.rotation)),
        1e-5 /* rad */);
  }
}

TEST(CameraFromBoard, DeclinesAViewOfTooFewCorners) {
  const Intrinsics k = marey::testing::webcam();
  BoardView view = view_of(k, before(2.0, {0.3, 0, 0}));
  view.corners.resize(4);
  EXPECT_FALSE(camera_from_board(k, view));
}

}  // namespace
}  // namespace marey::calib
