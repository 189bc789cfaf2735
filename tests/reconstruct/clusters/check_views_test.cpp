// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/check_views.h"

#include <utility>

#include <gtest/gtest.h>

#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

using marey::testing::ring_of_cameras;
using marey::testing::tagged_person;
using marey::testing::tags_of;

struct ViewScene {
  Body body = tagged_person();
  std::vector<Camera> cameras = ring_of_cameras();
  std::vector<TagOnSegment> tags = tags_of(body);
  std::vector<CameraDetections> detections =
      marey::testing::film(body,
                           marey::testing::range_of_motion(body),
                           cameras,
                           {60, 10.0, "rom", {0.2, {}, 0.0}, {}, {}});

  /// Swaps the videos of two cameras, as if they were listed in the wrong order.
  void swap_files(std::size_t a, std::size_t b) {
    std::swap(detections[a], detections[b]);
    std::swap(detections[a].camera, detections[b].camera);
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CheckViews, PassesViewsThatBelongTogether) {
  const ViewScene scene;
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  EXPECT_TRUE(status) << status.error().message();
}

TEST(CheckViews, PassesCamerasSideBySide) {
  // 8 cm apart and 5 m away: an angle of a degree, too little for a depth.
  ViewScene scene;
  scene.cameras = {marey::testing::webcam_at("cam0", {0.0, 1.4, 5.0}, {0.0, 1.0, 0.0}),
                   marey::testing::webcam_at("cam1", {0.08, 1.4, 5.0}, {0.0, 1.0, 0.0})};
  scene.detections = marey::testing::film(scene.body,
                                          marey::testing::range_of_motion(scene.body),
                                          scene.cameras,
                                          {60, 10.0, "rom", {0.2, {}, 0.0}, {}, {}});
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  EXPECT_TRUE(status) << status.error().message();
}

TEST(CheckViews, NamesTheFilesThatAreSwapped) {
  ViewScene scene;
  scene.swap_files(1, 2);
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kBadInput);
  EXPECT_EQ(status.error().where, "rom/cam2.mp4 and rom/cam1.mp4");
  EXPECT_TRUE(contains(status.error().cause, "files look exchanged"))
      << status.error().cause;
  EXPECT_TRUE(contains(status.error().next, "exchange them")) << status.error().next;
}

TEST(CheckViews, NoticesACameraThatSagged) {
  // Two degrees down: 31 px, in every pair that this camera is part of.
  ViewScene scene;
  scene.cameras[1].camera_from_world =
      RigidTransform{rotation_from_vector({glm::radians(2.0), 0.0, 0.0}),
                     glm::dvec3(0.0)} *
      scene.cameras[1].camera_from_world;
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().where, "rom/cam0.mp4");
  EXPECT_TRUE(contains(status.error().cause, "do not agree on where the tags are"))
      << status.error().cause;
}

TEST(CheckViews, DoesNotTakeACameraThatWasMovedForWrongTags) {
  // Moved along the ring and still looking at its middle: its rays nearly meet the
  // others' at wrong places, so that tags seem to have wrong sizes.
  ViewScene scene;
  scene.cameras[1] = marey::testing::webcam_at("cam1", {2.6, 2.4, 1.8}, {0.0, 0.95, 0.0});
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_TRUE(contains(status.error().cause, "do not agree on where the tags are"))
      << status.error().cause;
}

TEST(CheckViews, NamesTheOneTagOfAnotherSize) {
  ViewScene scene;
  scene.tags[3].size_m = 0.12;  // It is 0.09.
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().where, "[[tags.tag]]");
  EXPECT_EQ(status.error().cause, "tag 43 measures 0.090 m, not 0.120 m");
}

TEST(CheckViews, BlamesThePrintWhenAllTagsAreOfAnotherSize) {
  ViewScene scene;
  for (TagOnSegment& tag : scene.tags) tag.size_m *= 1.25;
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().where, "[[tags.tag]] and [board]");
  EXPECT_EQ(status.error().cause,
            "every tag on the body measures 0.80 times its size_m against the board");
}

TEST(CheckViews, NoticesSizesThatAreThreePercentWrong) {
  ViewScene one;
  one.tags[3].size_m *= 1.03;
  const Status of_one = check_views(one.cameras, one.detections, one.tags);
  ASSERT_FALSE(of_one);
  EXPECT_EQ(of_one.error().cause, "tag 43 measures 0.090 m, not 0.093 m");
  ViewScene all;
  for (TagOnSegment& tag : all.tags) tag.size_m /= 1.03;
  const Status of_all = check_views(all.cameras, all.detections, all.tags);
  ASSERT_FALSE(of_all);
  EXPECT_EQ(of_all.error().cause,
            "every tag on the body measures 1.03 times its size_m against the board");
}

TEST(CheckViews, PassesErrorsAsLargeAsThoseOfARuler) {
  ViewScene scene;
  for (TagOnSegment& tag : scene.tags) tag.size_m *= 1.01;
  EXPECT_TRUE(check_views(scene.cameras, scene.detections, scene.tags));
}

TEST(CheckViews, NoticesASwapInEightFrames) {
  ViewScene scene;
  scene.swap_files(1, 2);
  for (CameraDetections& camera : scene.detections) camera.frames.resize(8);
  const Status status = check_views(scene.cameras, scene.detections, scene.tags);
  ASSERT_FALSE(status);
  EXPECT_TRUE(contains(status.error().cause, "files look exchanged"))
      << status.error().cause;
}

TEST(CheckViews, PassesWhenThereIsNothingToJudge) {
  // If only one camera sees tags, wrong sizes cannot be detected.
  ViewScene scene;
  for (std::size_t c = 1; c < scene.detections.size(); ++c) {
    for (FrameDetections& frame : scene.detections[c].frames) frame.tags.clear();
  }
  for (TagOnSegment& tag : scene.tags) tag.size_m *= 2.0;
  EXPECT_TRUE(check_views(scene.cameras, scene.detections, scene.tags));
}

TEST(CheckViews, PassesATrialWithoutFrames) {
  ViewScene scene;
  for (CameraDetections& camera : scene.detections) camera.frames.clear();
  EXPECT_TRUE(check_views(scene.cameras, scene.detections, scene.tags));
}

}  // namespace
}  // namespace marey::reconstruct
