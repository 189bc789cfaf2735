// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/locate_rigid.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Dice;
using marey::testing::ring_of_cameras;
using marey::testing::webcam_at;

constexpr double kSize_m = 0.075;

double turn_rad(const RigidTransform& a, const RigidTransform& b) {
  return glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation));
}

/// Returns a camera at the origin of the floor plan, looking along -Z at a tag.
Camera front() {
  return webcam_at("front", {0, 1, 0}, {0, 1, -1});
}

/// Returns an upright tag in front of front(), turned by `tilt_rad` about the vertical.
RigidTransform tag_before(double distance_m, double tilt_rad) {
  return {rotation_from_vector({0.0, tilt_rad, 0.0}) *
              rotation_from_vector({std::numbers::pi, 0.0, 0.0}),
          {0.05, 1.02, -distance_m}};
}

TagDetection seen(const Camera& camera, const RigidTransform& world_from_tag) {
  const auto tag = marey::testing::see_tag(camera, world_from_tag, TagId{1}, kSize_m);
  EXPECT_TRUE(tag);
  return tag.value_or(TagDetection{});
}

std::optional<RigidPose> locate_tag(const Camera& camera, const TagDetection& tag) {
  std::vector<RigidPointView> views;
  append_corner_views(camera, tag, kSize_m, {}, views);
  return locate_rigid(views, planar_candidates(camera, tag, kSize_m));
}

TEST(PlanarCandidates, HoldTheTruthOfAnExactView) {
  const Camera camera = front();
  for (const double tilt_rad : {-0.9, -0.3, 0.0, 0.4, 1.0}) {
    const RigidTransform truth = tag_before(2.0, tilt_rad);
    const auto both = planar_candidates(camera, seen(camera, truth), kSize_m);
    ASSERT_EQ(both.size(), 2U);
    const bool first = turn_rad(both[0], truth) < turn_rad(both[1], truth);
    const RigidTransform& nearer = first ? both[0] : both[1];
    // 1e-9 px in corners 34 px apart, through an 8 x 8 system.
    EXPECT_LT(turn_rad(nearer, truth), 1e-6) << "tilt " << tilt_rad;
    EXPECT_LT(glm::distance(nearer.translation, truth.translation), 1e-6);
  }
}

TEST(PlanarCandidates, HoldTheTagTiltedTheOtherWay) {
  const Camera camera = front();
  const RigidTransform truth = tag_before(2.0, 0.5);
  const auto both = planar_candidates(camera, seen(camera, truth), kSize_m);
  ASSERT_EQ(both.size(), 2U);
  // Mirrored about the line of sight, which is hardly off the camera's axis.
  const double apart_rad = turn_rad(both[0], both[1]);
  EXPECT_NEAR(apart_rad, 1.0, 0.1);
}

TEST(PlanarCandidates, AreNoneForASquareWithoutArea) {
  const Camera camera = front();
  TagDetection tag;
  for (glm::dvec2& corner : tag.corners_px) corner = {600.0, 300.0};
  EXPECT_TRUE(planar_candidates(camera, tag, kSize_m).empty());
}

TEST(LocateRigid, RecoversAPoseSeenExactlyByOneCamera) {
  const Camera camera = front();
  const RigidTransform truth = tag_before(2.0, 0.7);
  const auto pose = locate_tag(camera, seen(camera, truth));
  ASSERT_TRUE(pose);
  EXPECT_LT(turn_rad(pose->world_from_body, truth), 1e-6);
  EXPECT_LT(glm::distance(pose->world_from_body.translation, truth.translation), 1e-6);
  EXPECT_LT(pose->rms_px, 1e-6);
}

TEST(LocateRigid, FindsItsWayFromAPoorStartWithSeveralCameras) {
  const auto cameras = ring_of_cameras();
  const RigidTransform truth{rotation_from_vector({0.4, 0.3, -0.2}), {0.1, 1.1, 0.2}};
  std::vector<RigidPointView> views;
  for (std::size_t c = 0; c < 2; ++c) {
    for (const glm::dvec3& p : {glm::dvec3(0.1, 0, 0),
                                glm::dvec3(-0.1, 0, 0),
                                glm::dvec3(0, 0.1, 0),
                                glm::dvec3(0, 0, 0.1)}) {
      views.push_back({&cameras[c], p, *project(cameras[c], truth * p), 0.3});
    }
  }
  // Half a radian and a quarter of a metre off.
  const RigidTransform start{rotation_from_vector({0.1, 0.6, 0.1}), {0.3, 1.0, 0.1}};
  const auto pose = locate_rigid(views, std::array{start});
  ASSERT_TRUE(pose);
  EXPECT_LT(turn_rad(pose->world_from_body, truth), 1e-6);
  EXPECT_LT(glm::distance(pose->world_from_body.translation, truth.translation), 1e-6);
}

TEST(LocateRigid, IsSureOfATagThatIsNearAndTilted) {
  const Camera camera = front();
  Dice dice(6);
  for (int run = 0; run < 20; ++run) {
    const TagDetection tag = marey::testing::disturbed(
        seen(camera, tag_before(0.5, 0.6)), {0.2, {}, 0.0}, dice);
    const auto pose = locate_tag(camera, tag);
    ASSERT_TRUE(pose);
    // Half a radian of perspective over 150 px changes the corners by many pixels.
    EXPECT_GT(pose->ambiguity_ratio, 20.0);
    EXPECT_LT(turn_rad(pose->world_from_body, tag_before(0.5, 0.6)), 0.1);
  }
}

// A tag 17 px wide tilted by 0.4 rad looks nearly the same as with the opposite tilt.
// Only two of its eight numbers differ, so the ratio detects most wrong poses, not all.
TEST(LocateRigid, KnowsThatATagFarOffIsAmbiguous) {
  const Camera camera = front();
  Dice dice(7);
  int unsure = 0;
  int wrong = 0;
  int wrong_and_sure = 0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    const RigidTransform truth = tag_before(4.0, 0.4);
    const TagDetection tag =
        marey::testing::disturbed(seen(camera, truth), {0.2, {}, 0.0}, dice);
    const auto pose = locate_tag(camera, tag);
    ASSERT_TRUE(pose);
    const bool sure = pose->ambiguity_ratio > 3.0;
    const bool is_wrong = turn_rad(pose->world_from_body, truth) > 0.4;
    unsure += !sure;
    wrong += is_wrong;
    wrong_and_sure += is_wrong && sure;
  }
  EXPECT_GT(wrong, kRuns / 10);
  EXPECT_GT(unsure, kRuns / 2);
  EXPECT_LT(wrong_and_sure, wrong / 2);
}

TEST(LocateRigid, IsUnambiguousWhenAllStartsEndInOnePlace) {
  const Camera camera = front();
  const RigidTransform truth = tag_before(1.0, 0.5);
  std::vector<RigidPointView> views;
  append_corner_views(camera, seen(camera, truth), kSize_m, {}, views);
  const auto pose = locate_rigid(views, std::array{truth, truth});
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->ambiguity_ratio, std::numeric_limits<double>::infinity());
}

TEST(LocateRigid, KeepsItsAccuracyWithOneWrongCorner) {
  const auto cameras = ring_of_cameras();
  const RigidTransform truth{rotation_from_vector({0.0, 0.7, 0.0}) *
                                 rotation_from_vector({std::numbers::pi, 0.0, 0.0}),
                             {0.1, 1.1, 0.2}};
  std::vector<RigidPointView> views;
  for (std::size_t c = 0; c < 2; ++c) {
    append_corner_views(cameras[c], seen(cameras[c], truth), kSize_m, {}, views);
  }
  views[3].pixel_px.x += 15.0;
  const auto pose = locate_rigid(views, std::array{truth});
  ASSERT_TRUE(pose);
  // Huber's 3 sigma of 0.3 px in place of 15 px: like 0.9 px in one of sixteen numbers.
  EXPECT_LT(glm::distance(pose->world_from_body.translation, truth.translation), 2e-3);
}

TEST(LocateRigid, DeclinesFewerThanFourViews) {
  const Camera camera = front();
  const RigidTransform truth = tag_before(1.0, 0.5);
  std::vector<RigidPointView> views;
  append_corner_views(camera, seen(camera, truth), kSize_m, {}, views);
  views.pop_back();
  EXPECT_FALSE(locate_rigid(views, std::array{truth}));
}

TEST(LocateRigid, DeclinesStartsBehindTheCamera) {
  const Camera camera = front();
  std::vector<RigidPointView> views;
  append_corner_views(camera, seen(camera, tag_before(1.0, 0.5)), kSize_m, {}, views);
  EXPECT_FALSE(locate_rigid(views, std::array{tag_before(-1.0, 0.5)}));
  EXPECT_FALSE(locate_rigid(views, {}));
}

}  // namespace
}  // namespace marey::reconstruct
