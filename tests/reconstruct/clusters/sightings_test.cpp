// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/sightings.h"

#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

const std::vector<TagOnSegment> kTags{{TagId{50}, HumanBone::kHips, 0.1},
                                      {TagId{40}, HumanBone::kHead, 0.1}};

CameraDetections camera_with(int camera,
                             std::vector<std::pair<int, std::vector<int>>> frames) {
  CameraDetections out;
  out.camera = CameraId{camera};
  out.rate.hz = 25.0;
  for (const auto& [frame, ids] : frames) {
    out.frames.push_back({frame, {}});
    for (const int id : ids) {
      TagDetection tag;
      tag.id = TagId{id};
      out.frames.back().tags.push_back(tag);
    }
  }
  return out;
}

TEST(GroupSightings, SpanAllFramesThatAnyCameraHas) {
  const std::vector<CameraDetections> detections{camera_with(0, {{3, {40}}, {4, {}}}),
                                                 camera_with(1, {}),
                                                 camera_with(2, {{1, {50}}})};
  const Sightings s = group_sightings(detections, kTags);
  EXPECT_EQ(s.first_frame, 1);
  EXPECT_EQ(s.last_frame(), 4);
  ASSERT_EQ(s.frames.size(), 4U);
  EXPECT_EQ(s.frames[0].size(), 1U);
  EXPECT_TRUE(s.frames[1].empty());
  EXPECT_EQ(s.frames[2].size(), 1U);
  EXPECT_EQ(s.rate.hz, 25.0);
}

TEST(GroupSightings, OrderAFrameByTagThenCamera) {
  const std::vector<CameraDetections> detections{camera_with(0, {{0, {40, 50}}}),
                                                 camera_with(1, {{0, {40, 50}}})};
  const auto frame = group_sightings(detections, kTags).frames.at(0);
  ASSERT_EQ(frame.size(), 4U);
  // By position in the subject's list, in which 50 comes first.
  EXPECT_EQ(frame[0].tag, 0U);
  EXPECT_EQ(frame[0].camera, CameraId{0});
  EXPECT_EQ(frame[1].tag, 0U);
  EXPECT_EQ(frame[1].camera, CameraId{1});
  EXPECT_EQ(frame[2].tag, 1U);
  EXPECT_EQ(frame[2].detection, &detections[0].frames[0].tags[0]);
}

TEST(GroupSightings, LeavesOutTagsThatAreNotWorn) {
  const std::vector<CameraDetections> detections{camera_with(0, {{0, {7, 40, 99}}})};
  const auto frame = group_sightings(detections, kTags).frames.at(0);
  ASSERT_EQ(frame.size(), 1U);
  EXPECT_EQ(frame[0].detection->id, TagId{40});
}

TEST(GroupSightings, HaveNoFramesWhenNoCameraHas) {
  const std::vector<CameraDetections> detections{camera_with(0, {}), camera_with(1, {})};
  EXPECT_TRUE(group_sightings(detections, kTags).frames.empty());
}

TEST(SolvedSegment, IsTheFootForToesAndItselfForAllOthers) {
  for (const HumanBone bone : human_bones()) {
    const HumanBone expected = bone == HumanBone::kLeftToes    ? HumanBone::kLeftFoot
                               : bone == HumanBone::kRightToes ? HumanBone::kRightFoot
                                                               : bone;
    EXPECT_EQ(solved_segment(bone), expected) << name(bone);
  }
}

}  // namespace
}  // namespace marey::reconstruct
