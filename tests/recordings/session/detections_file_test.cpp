// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/detections_file.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

TagDetection a_tag(int id) {
  TagDetection tag;
  tag.id = TagId{id};
  // Thirds and sevenths: they have no exact decimal form.
  for (std::size_t i = 0; i < 4; ++i) {
    tag.corners_px[i] = {100.0 + kCornerSides[i][0] * 40.0 / 3.0,
                         200.0 + kCornerSides[i][1] * (20.0 - id / 7.0)};
  }
  tag.sigma_px = 0.2 / 3.0;
  tag.decision_margin = 61.5;
  tag.hamming = 1;
  return tag;
}

/// Frames 5 to 8; the first and the last are empty.
CameraDetections four_frames() {
  CameraDetections found;
  found.source = "walk/cam 1, left.mp4";
  found.camera = CameraId{2};
  found.width_px = 1280;
  found.height_px = 720;
  found.rate = {30000.0 / 1001.0};
  found.offset = Timestamp{-11'100'001};
  found.dropped = {12, 4};
  found.damaged_frames = 3;
  found.frames = {{5, {}}, {6, {a_tag(3), a_tag(40)}}, {7, {a_tag(40)}}, {8, {}}};
  return found;
}

void expect_same(const TagDetection& a, const TagDetection& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.corners_px, b.corners_px);
  EXPECT_EQ(a.sigma_px, b.sigma_px);
  EXPECT_EQ(a.decision_margin, b.decision_margin);
  EXPECT_EQ(a.hamming, b.hamming);
}

std::string detections_mistake(const CameraDetections& detections,
                               std::string_view from,
                               std::string_view to) {
  const auto found = parse_detections(
      testing::replace_first(detections_text(detections, "k"), from, to), "k", "d.csv");
  return found ? "" : found.error().message();
}

TEST(DetectionsFile, GivesBackEveryDoubleAndEveryEmptyFrame) {
  const CameraDetections written = four_frames();
  const auto read = parse_detections(detections_text(written, "k"), "k", "d.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(*read);
  ASSERT_EQ((*read)->frames.size(), written.frames.size());
  for (std::size_t i = 0; i < written.frames.size(); ++i) {
    const FrameDetections& a = written.frames[i];
    const FrameDetections& b = (*read)->frames[i];
    EXPECT_EQ(a.frame, b.frame);
    ASSERT_EQ(a.tags.size(), b.tags.size());
    for (std::size_t j = 0; j < a.tags.size(); ++j) expect_same(a.tags[j], b.tags[j]);
  }
}

TEST(DetectionsFile, KeepsThePropertiesOfTheCamera) {
  const CameraDetections written = four_frames();
  const auto read = parse_detections(detections_text(written, "k"), "k", "d.csv");
  ASSERT_TRUE(read);
  ASSERT_TRUE(*read);
  EXPECT_EQ((*read)->source, written.source);
  EXPECT_EQ((*read)->camera, written.camera);
  EXPECT_EQ((*read)->width_px, written.width_px);
  EXPECT_EQ((*read)->height_px, written.height_px);
  EXPECT_EQ((*read)->rate.hz, written.rate.hz);
  EXPECT_EQ((*read)->offset, written.offset);
  EXPECT_EQ((*read)->dropped.unsure, 12);
  EXPECT_EQ((*read)->dropped.duplicated, 4);
  EXPECT_EQ((*read)->damaged_frames, 3);
}

TEST(DetectionsFile, DoesNotTakeAnUnknownOffsetForZero) {
  CameraDetections written = four_frames();
  written.offset.reset();
  const auto read = parse_detections(detections_text(written, "k"), "k", "d.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(*read);
  EXPECT_FALSE((*read)->offset);
}

TEST(DetectionsFile, IsNotWrittenForANameOfTwoLines) {
  const ScratchFolder folder;
  CameraDetections found = four_frames();
  found.source = "walk\nrun.mp4";
  const Status written = write_detections(folder / "cam0.csv", found, "k");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message(),
            "walk run.mp4: the recording's name holds a line break. Next: rename it, and "
            "correct its path in the session.");
}

TEST(DetectionsFile, RefusesATagWithoutAnArea) {
  std::string text = detections_text(four_frames(), "k");
  const std::size_t row = text.find("\n6,3,") + 1;
  text.replace(row, text.find('\n', row) - row, "6,3,1,1,9,1,9,1,1,1,0.1,61.5,1");
  const auto read = parse_detections(text, "k", "d.csv");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, "d.csv:6");
  EXPECT_EQ(read.error().cause, "a tag's corners enclose no area");
}

TEST(DetectionsFile, RefusesATagWithoutSigma) {
  EXPECT_TRUE(detections_mistake(four_frames(), ",0.06666666666666667,", ",0,")
                  .starts_with("d.csv:6: a tag's sigma is not"));
}

TEST(DetectionsFile, IsReadFromDisk) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_detections(folder / "detections/cam0.csv", four_frames(), "k"));
  const auto read = read_detections(folder / "detections/cam0.csv", "k");
  ASSERT_TRUE(read);
  EXPECT_TRUE(*read);
}

TEST(DetectionsFile, KeepsAVideoWithoutFrames) {
  const auto read = parse_detections(detections_text({}, "k"), "k", "d.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(*read);
  EXPECT_TRUE((*read)->frames.empty());
}

TEST(DetectionsFile, ThatIsAbsentIsNoAnswer) {
  const ScratchFolder folder;
  const auto read = read_detections(folder / "cam0.csv", "k");
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
}

TEST(DetectionsFile, ReturnsNothingForAnotherKey) {
  const auto read = parse_detections(detections_text(four_frames(), "k"), "k2", "d.csv");
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
}

TEST(DetectionsFile, ReturnsNothingForAnotherVersion) {
  const auto read = parse_detections("# marey detections 99 k\nfoo\n", "k", "d.csv");
  ASSERT_TRUE(read);
  EXPECT_FALSE(*read);
}

TEST(DetectionsFile, RejectsAFileThatIsNoTable) {
  const auto read = parse_detections("frame,tag\n", "k", "d.csv");
  ASSERT_FALSE(read);
  EXPECT_EQ(
      read.error().message(),
      "d.csv:1: this is not a table of detections. Next: delete the file; it will be "
      "made again.");
}

TEST(DetectionsFile, RefusesAnEmptyFile) {
  const auto read = parse_detections("", "k", "d.csv");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().where, "d.csv:1");
}

TEST(DetectionsFile, NamesTheLineOfARowThatDoesNotFit) {
  EXPECT_TRUE(detections_mistake(four_frames(), "6,40,", "6,40,x")
                  .starts_with("d.csv:7: the row is not 13 numbers"));
}

TEST(DetectionsFile, RefusesFramesOutOfOrder) {
  EXPECT_TRUE(detections_mistake(four_frames(), "\n7,", "\n9,")
                  .starts_with("d.csv:8: the frames are not in order"));
}

TEST(DetectionsFile, RefusesTagsOutOfOrder) {
  EXPECT_TRUE(detections_mistake(four_frames(), "6,3,", "6,41,")
                  .starts_with("d.csv:7: the tags are not in order"));
}

TEST(DetectionsFile, RefusesATagOfAnEmptyFrame) {
  EXPECT_TRUE(detections_mistake(four_frames(), "\n8,", "\n7,")
                  .starts_with("d.csv:9: a frame is listed twice"));
}

TEST(DetectionsFile, RefusesATableCutShort) {
  EXPECT_TRUE(detections_mistake(four_frames(), "# end, frames: 4\n", "")
                  .starts_with("d.csv:9: the end of the"));
}

TEST(DetectionsFile, RefusesATableWithAFrameTooFew) {
  EXPECT_TRUE(detections_mistake(four_frames(), "8,,,,,,,,,,,,\n", "")
                  .starts_with("d.csv:9: the table's end does"));
}

/// Frame 5 has tags and points, frame 6 points alone.
CameraDetections with_points() {
  CameraDetections found = four_frames();
  const PointDetection first{0, {1.0 / 3.0, 2.0 / 7.0}, 0.1 / 3.0};
  const PointDetection later{11, {-0.4, 719.25}, 0.05};
  found.frames = {{5, {a_tag(3)}, {first, later}}, {6, {}, {later}}, {7, {}}};
  return found;
}

TEST(DetectionsFile, GivesBackThePointsOfABoard) {
  const CameraDetections written = with_points();
  const auto read = parse_detections(detections_text(written, "k"), "k", "d.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(*read);
  ASSERT_EQ((*read)->frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& points = written.frames[i].points;
    const auto& again = (*read)->frames[i].points;
    EXPECT_EQ((*read)->frames[i].tags.size(), written.frames[i].tags.size());
    ASSERT_EQ(again.size(), points.size());
    for (std::size_t j = 0; j < points.size(); ++j) {
      EXPECT_EQ(again[j].point, points[j].point);
      EXPECT_EQ(again[j].pixel_px, points[j].pixel_px);
      EXPECT_EQ(again[j].sigma_px, points[j].sigma_px);
    }
  }
}

TEST(DetectionsFile, RefusesPointsThatDoNotFit) {
  EXPECT_TRUE(detections_mistake(with_points(), "\n5,11,", "\n5,x,")
                  .starts_with("d.csv:7: the row is not 5 numbers"));
  EXPECT_TRUE(detections_mistake(with_points(), "\n5,11,", "\n5,0,")
                  .starts_with("d.csv:7: the points are not in order"));
  EXPECT_TRUE(detections_mistake(with_points(), "\n6,11,", "\n6,-1,")
                  .starts_with("d.csv:8: a point's number is below zero"));
  EXPECT_TRUE(detections_mistake(with_points(), "719.25,0.05\n6,", "719.25,0\n6,")
                  .starts_with("d.csv:7: a point's sigma is not above zero"));
  EXPECT_TRUE(detections_mistake(with_points(), "\n7,", "\n6,")
                  .starts_with("d.csv:9: a frame is listed twice"));
}

}  // namespace
}  // namespace marey::recordings
