// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/estimate_world_up.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

constexpr double kUprightTag_m = 0.2;

/// Tags on a pillar in the middle, the lowest with its edge on the floor.
std::vector<CameraDetections> pillar(const std::vector<Camera>& cameras) {
  auto out = marey::testing::unseeing(cameras, 3, 30.0, "static");
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (FrameDetections& frame : out[c].frames) {
      for (int i = 0; i < 16; ++i) {
        const double angle = 0.5 * std::numbers::pi * (i % 4) + 0.7;
        const glm::dquat turn = rotation_from_vector({0.0, angle, 0.0}) *
                                rotation_from_vector({std::numbers::pi, 0.0, 0.0});
        const RigidTransform tag_at{
            turn,
            glm::dvec3(0.0, 0.1 + 0.4 * (i / 4), 0.0) + turn * glm::dvec3(0, 0, -0.1)};
        const auto tag =
            marey::testing::see_tag(cameras[c], tag_at, TagId{i}, kUprightTag_m, 1.4);
        if (tag) frame.tags.push_back(*tag);
      }
    }
  }
  return out;
}

TEST(UpFromTags, FindsFloorAndUpOfATurnedWorld) {
  const auto truth = marey::testing::ring_of_cameras();
  const auto standing = pillar(truth);
  const RigidTransform old_from_truth{rotation_from_vector({0.7, -0.4, 1.1}),
                                      {2.0, -1.0, 0.5}};
  CalibratedRig rig;
  rig.cameras = truth;
  for (Camera& camera : rig.cameras) {
    camera.camera_from_world = camera.camera_from_world * inverse(old_from_truth);
  }
  const auto new_from_old = up_from_tags(rig.cameras, standing);
  ASSERT_TRUE(new_from_old);
  move_world(*new_from_old, rig);
  for (std::size_t c = 0; c < truth.size(); ++c) {
    // Heights are unchanged; the origin's position on the floor is a convention.
    EXPECT_NEAR(centre_in_world(rig.cameras[c]).y, centre_in_world(truth[c]).y, 1e-3);
  }
  EXPECT_GT(centre_in_world(rig.cameras[0]).z, 1.0);
  EXPECT_NEAR(centre_in_world(rig.cameras[0]).x, 0.0, 1e-6);
}

/// Tags that lie face up, the last one at the given height.
std::vector<CameraDetections> lying_tags(const std::vector<Camera>& cameras,
                                         double last_m) {
  auto out = marey::testing::unseeing(cameras, 1, 30.0, "floor");
  const glm::dquat flat = rotation_from_vector({0.5 * std::numbers::pi, 0.0, 0.0});
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (int i = 0; i < 4; ++i) {
      const RigidTransform tag_at{
          flat, glm::dvec3(0.4 * (i % 2), i == 3 ? last_m : 0.0, 0.4 * (i / 2))};
      const auto tag =
          marey::testing::see_tag(cameras[c], tag_at, TagId{i}, kUprightTag_m, 1.4);
      if (tag) out[c].frames[0].tags.push_back(*tag);
    }
  }
  return out;
}

TEST(UpFromFloorTags, FindsTheirPlane) {
  const auto truth = marey::testing::ring_of_cameras();
  const RigidTransform old_from_truth{rotation_from_vector({0.7, -0.4, 1.1}),
                                      {2.0, -1.0, 0.5}};
  CalibratedRig rig;
  rig.cameras = truth;
  for (Camera& camera : rig.cameras) {
    camera.camera_from_world = camera.camera_from_world * inverse(old_from_truth);
  }
  const auto new_from_old = up_from_floor_tags(rig.cameras, lying_tags(truth, 0.0));
  ASSERT_TRUE(new_from_old);
  move_world(*new_from_old, rig);
  for (std::size_t c = 0; c < truth.size(); ++c) {
    EXPECT_NEAR(centre_in_world(rig.cameras[c]).y, centre_in_world(truth[c]).y, 1e-6);
  }
}

TEST(UpFromFloorTags, DeclinesATagOnABox) {
  const auto cameras = marey::testing::ring_of_cameras();
  EXPECT_FALSE(up_from_floor_tags(cameras, lying_tags(cameras, 0.3)));
}

TEST(UpFromTags, DeclinesWithoutTags) {
  const auto cameras = marey::testing::ring_of_cameras();
  EXPECT_FALSE(
      up_from_tags(cameras, marey::testing::unseeing(cameras, 3, 30.0, "static")));
}

TEST(UpFromTags, DeclinesCamerasThatAreTurnedAlike) {
  const auto cameras = marey::testing::ring_of_cameras();
  const std::vector<Camera> one{cameras[0], cameras[0]};
  EXPECT_FALSE(up_from_tags(one, pillar(one)));
}

}  // namespace
}  // namespace marey::calib
