// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/motion_tables.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Two joints, frames 3 and 4 at 30 Hz; the second frame is rotated by more than half a
/// turn.
EstimatedMotion a_motion() {
  EstimatedMotion estimated;
  Motion& motion = estimated.motion;
  motion.skeleton.joints.resize(2);
  motion.skeleton.joints[0].name = "hips";
  motion.skeleton.joints[1].name = "spine";
  motion.skeleton.joints[1].parent = JointIndex{0};
  motion.skeleton.joints[1].parent_from_joint.translation = {0.0, 0.1, 0.0};
  motion.rate = {30.0};
  motion.first_frame = 3;
  const glm::dquat one(1.0, 0.0, 0.0, 0.0);
  motion.poses.push_back({{0.25, 1.0, -1e-9}, {one, one}});
  motion.poses.push_back({{0.25, 1.0, 0.0}, {rotation_from_vector({0, 2, 0}), one}});
  motion.poses[1].parent_from_joint[0] = -motion.poses[1].parent_from_joint[0];
  estimated.uncertainty = {{{0.001, Source::kMeasured}, {0.002, Source::kRepaired}},
                           {{0.003, Source::kInferred}, {0.004, Source::kMeasured}}};
  return estimated;
}

TEST(JointsCsv, IsWrittenAsPromised) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_joints_csv(folder / "joints.csv", a_motion()));
  EXPECT_EQ(*read_file(folder / "joints.csv"),
            "frame,time,joint,x,y,z,sigma\n"
            "3,0.100000,hips,0.250000,1.000000,0.000000,0.001000\n"
            "3,0.100000,spine,0.250000,1.100000,0.000000,0.002000\n"
            "4,0.133333,hips,0.250000,1.000000,0.000000,0.003000\n"
            "4,0.133333,spine,0.250000,1.100000,0.000000,0.004000\n");
}

TEST(PlacesCsv, OmitsColumnsOfUnknownData) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_places_csv(folder / "places.csv", a_motion().motion));
  EXPECT_EQ(*read_file(folder / "places.csv"),
            "frame,time,joint,x,y,z\n"
            "3,0.100000,hips,0.250000,1.000000,0.000000\n"
            "3,0.100000,spine,0.250000,1.100000,0.000000\n"
            "4,0.133333,hips,0.250000,1.000000,0.000000\n"
            "4,0.133333,spine,0.250000,1.100000,0.000000\n");
}

TEST(SegmentsCsv, IsWrittenAsPromisedWithPositiveW) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_segments_csv(folder / "segments.csv", a_motion()));
  EXPECT_EQ(
      *read_file(folder / "segments.csv"),
      "frame,time,segment,x,y,z,qw,qx,qy,qz,source\n"
      "3,0.100000,hips,0.250000,1.000000,0.000000,1.000000,0.000000,0.000000,0.000000,"
      "measured\n"
      "3,0.100000,spine,0.250000,1.100000,0.000000,1.000000,0.000000,0.000000,0.000000,"
      "repaired\n"
      "4,0.133333,hips,0.250000,1.000000,0.000000,0.540302,0.000000,0.841471,0.000000,"
      "inferred\n"
      "4,0.133333,spine,0.250000,1.100000,0.000000,0.540302,0.000000,0.841471,0.000000,"
      "measured\n");
}

TEST(JointsCsv, GivesBackItsRows) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_joints_csv(folder / "joints.csv", a_motion()));
  const auto rows = read_joints_csv(folder / "joints.csv");
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 4U);
  const JointRow& row = (*rows)[3];
  EXPECT_EQ(row.frame, 4);
  EXPECT_EQ(row.time_s, 0.133333);
  EXPECT_EQ(row.joint, "spine");
  EXPECT_EQ(row.p_in_world, glm::dvec3(0.25, 1.1, 0.0));
  EXPECT_EQ(row.sigma_m, 0.004);
}

TEST(SegmentsCsv, GivesBackItsRows) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_segments_csv(folder / "segments.csv", a_motion()));
  const auto rows = read_segments_csv(folder / "segments.csv");
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 4U);
  const SegmentTableRow& row = (*rows)[2];
  EXPECT_EQ(row.segment, "hips");
  EXPECT_EQ(row.source, Source::kInferred);
  EXPECT_EQ(row.world_from_segment.rotation, glm::dquat(0.540302, 0.0, 0.841471, 0.0));
}

TEST(JointsCsv, HasOnlyItsHeaderWithoutFrames) {
  const ScratchFolder folder;
  EstimatedMotion none = a_motion();
  none.motion.poses.clear();
  none.uncertainty.clear();
  ASSERT_TRUE(write_joints_csv(folder / "joints.csv", none));
  const auto rows = read_joints_csv(folder / "joints.csv");
  ASSERT_TRUE(rows);
  EXPECT_TRUE(rows->empty());
}

TEST(JointsCsv, AcceptsLineEndsOfWindows) {
  const auto rows = parse_joints_csv(
      "frame,time,joint,x,y,z,sigma\r\n3,0.1,hips,1,2,3,0.5\r\n", "joints.csv");
  ASSERT_TRUE(rows) << rows.error().message();
  EXPECT_EQ((*rows)[0].sigma_m, 0.5);
}

TEST(JointsCsv, NamesTheLineOfARowTooShort) {
  const auto rows = parse_joints_csv(
      "frame,time,joint,x,y,z,sigma\n3,0.1,hips,1,2,3,0.5\n3,0.1,spine,1,2\n",
      "joints.csv");
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().message(),
            "joints.csv:3: the row does not match 'frame,time,joint,x,y,z,sigma'. Next: "
            "correct or remove it.");
}

TEST(JointsCsv, RefusesARowTooLong) {
  EXPECT_FALSE(parse_joints_csv("frame,time,joint,x,y,z,sigma\n3,0.1,hips,1,2,3,0.5,6\n",
                                "joints.csv"));
}

TEST(JointsCsv, RejectsTextInPlaceOfNumbers) {
  EXPECT_FALSE(parse_joints_csv("frame,time,joint,x,y,z,sigma\n3,0.1,hips,1,2,nan,0.5\n",
                                "joints.csv"));
}

TEST(SegmentsCsv, RefusesAnUnknownSource) {
  EXPECT_FALSE(
      parse_segments_csv("frame,time,segment,x,y,z,qw,qx,qy,qz,source\n"
                         "3,0.1,hips,1,2,3,1,0,0,0,guessed\n",
                         "segments.csv"));
}

TEST(SegmentsCsv, RefusesAnotherTable) {
  const auto rows = parse_segments_csv("frame,time,joint,x,y,z,sigma\n", "joints.csv");
  ASSERT_FALSE(rows);
  EXPECT_EQ(rows.error().where, "joints.csv:1");
}

TEST(JointsCsv, DeclinesANameThatATableCannotHold) {
  const ScratchFolder folder;
  EstimatedMotion estimated = a_motion();
  estimated.motion.skeleton.joints[1].name = "spine,1";
  const Status status = write_joints_csv(folder / "joints.csv", estimated);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().cause, "a table cannot hold the joint name 'spine,1'");
  EXPECT_FALSE(std::filesystem::exists(folder / "joints.csv"));
}

}  // namespace
}  // namespace marey::recordings
