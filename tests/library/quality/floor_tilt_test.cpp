// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/floor_tilt.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

LibraryMotion tilted(const LibraryMotion& clip, double degrees, const glm::dvec3& axis) {
  LibraryMotion out = clip;
  const glm::dquat turn = glm::angleAxis(degrees * kDegree, axis);
  for (Pose& pose : out.motion.poses) {
    pose.root_in_world = turn * pose.root_in_world;
    pose.parent_from_joint[0] = turn * pose.parent_from_joint[0];
  }
  return out;
}

double tilt_deg(const LibraryMotion& clip) {
  return figure(measured(clip), "tilt_deg").value;
}

TEST(FloorTilt, TheFloorOfAWalkHasItsSlope) {
  const LibraryMotion clip = walking_clip(400, 60.0);
  EXPECT_LT(tilt_deg(clip), 0.3);
  EXPECT_NEAR(tilt_deg(tilted(clip, 3.0, {1.0, 0.0, 0.0})), 3.0, 0.6);
}

// The slope across a standing body shows in the heights of its feet, less three errors.
TEST(FloorTilt, FeetOfAStandingBodyShowTheSlopeAcross) {
  const LibraryMotion clip = standing_clip(60, 30.0);
  EXPECT_LT(tilt_deg(clip), 0.1);
  const double across = tilt_deg(tilted(clip, 3.0, {0.0, 0.0, 1.0}));
  EXPECT_GT(across, 0.9);
  EXPECT_LT(across, 3.0);
}

// A raised foot at rest is not the floor.
TEST(FloorTilt, ARaisedFootIsAnOutlier) {
  LibraryMotion clip = walking_clip(400, 60.0);
  const LibraryMotion start = clip;
  // After the walk the body stands, and holds its right foot up for one second.
  const std::size_t knee = index(*clip.motion.skeleton.find(HumanBone::kRightLowerLeg));
  for (int t = 0; t < 60; ++t) {
    Pose pose = start.motion.poses.back();
    pose.parent_from_joint[knee] =
        glm::angleAxis(1.4, glm::dvec3(1.0, 0.0, 0.0)) * pose.parent_from_joint[knee];
    clip.motion.poses.push_back(pose);
    clip.contacts.push_back(FootParts{1, 1, 0, 0});
  }
  EXPECT_LT(tilt_deg(clip), 0.5);
}

}  // namespace
}  // namespace marey::library
