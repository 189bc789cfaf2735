// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/motion/bvh.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Returns the error message of reading `text`.
std::string refusal(const std::string& text) {
  const auto read = parse_bvh(text, "walk.bvh");
  return read ? "no refusal" : read.error().message();
}

std::filesystem::path real_file(const std::string& name) {
  return marey::testing::shared_data() / "mocap" / name;
}

const std::string kTwoJoints =
    "HIERARCHY\n"
    "ROOT hips\n"
    "{\n"
    "  OFFSET 0 0 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT spine\n"
    "  {\n"
    "    OFFSET 0 10 0\n"
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 0 5 0\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.0333333\n";

TEST(ReadBvh, MultipliesRotationsInTheOrderOfTheChannels) {
  std::string text = kTwoJoints;
  text.replace(
      text.find("Zrotation Xrotation Yrotation"), 29, "Yrotation Zrotation Xrotation");
  const auto read = parse_bvh(text + "0 0 0 90 0 90 0 0 0\n1 2 3 0 0 0 0 0 0\n", "a.bvh");
  ASSERT_TRUE(read) << read.error().message();
  // Ry(90) Rx(90) takes the spine, along y, to z and then to x.
  const auto joints = world_from_joints(read->motion.skeleton, read->motion.poses[0]);
  EXPECT_LT(glm::distance(joints[1].translation, glm::dvec3(0.1, 0, 0)), 1e-12);
}

TEST(ReadBvh, TakesAnyDialect) {
  const std::string text =
      "\xEF\xBB\xBFhierarchy\r\nRoot my hips {\r\n\toffset\t0 1 0\r\n"
      "\tChannels 2 XROTATION yposition\r\n\tend site {\r\n\toffset 0 1 0\r\n\t}\r\n}\r\n"
      "Motion\r\nframes: 1\r\nframe time: 1e-2\r\n\t+90 7e1  \r\n\r\n";
  const auto read = parse_bvh(text, "a.bvh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->motion.skeleton.joints[0].name, "my hips");
  EXPECT_EQ(read->motion.rate.hz, 100.0);
  EXPECT_NEAR(read->motion.poses[0].root_in_world.y, 0.7, 1e-12);
}

// 3ds Max writes blanks in names, MotionBuilder colons and every joint's position; others
// omit optional parts.
TEST(ReadBvh, TakesWhatOtherProgramsWrite) {
  const std::string text =
      "HIERARCHY\r\nROOT Actor:Bip01 Pelvis\r\n{\r\n\tOFFSET 0.00 0.00 0.00\r\n"
      "\tCHANNELS 6 Zposition Xposition Yposition Xrotation Yrotation Zrotation\r\n"
      "\tJOINT Actor:Bip01 L Thigh\r\n\t{\r\n\t\tOFFSET -1.5e+01 .0 0.\r\n"
      "\t\tCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\r\n"
      "\t\tEnd Site\r\n\t\t{\r\n\t\t\tCHANNELS 0\r\n\t\t}\r\n\t}\r\n"
      "\tJOINT Bip01 R Thigh\r\n\t{\r\n\t\tOFFSET 15 0 0\r\n"
      "\t\tCHANNELS 3 Zrotation Yrotation Xrotation\r\n\t}\r\n}\r\n\r\n"
      "Motion\r\nFrames:\t1\r\nFrame Time:.04\r\n"
      "300 1e+2 200\t0 0 90 -15 1 0 0 0 0 0 0 0\r\n";
  const auto read = parse_bvh(text, "a.bvh");
  ASSERT_TRUE(read) << read.error().message();
  const auto& [skeleton, rate, first, poses] = read->motion;
  EXPECT_EQ(skeleton.joints.at(1).name, "Actor:Bip01 L Thigh");
  EXPECT_EQ(rate.hz, 25.0);
  EXPECT_LT(glm::distance(poses.at(0).root_in_world, glm::dvec3(1, 2, 3)), 1e-12);
  EXPECT_NEAR(read->ignored_translation_m, 0.01, 1e-12);
  const auto joints = world_from_joints(skeleton, poses.at(0));
  EXPECT_LT(glm::distance(joints.at(2).translation, glm::dvec3(1, 2.15, 3)), 1e-12);
}

TEST(ReadBvh, RefusesAnEndSiteThatMoves) {
  std::string text = kTwoJoints;
  text.insert(text.find("    }\n  }\n}"), "      CHANNELS 1 Xrotation\n");
  EXPECT_NE(refusal(text).find("walk.bvh:13: an End Site has channels"),
            std::string::npos);
}

TEST(ReadBvh, NamesTheLineOfAMotionWithoutItsLabels) {
  for (const char* label : {"Frames:", "Frame Time:"}) {
    std::string text = kTwoJoints;
    text.replace(text.find(label), std::string(label).size(), "Bilder");
    EXPECT_NE(refusal(text).find("expected \"" + std::string(label) + "\""),
              std::string::npos)
        << refusal(text);
  }
}

TEST(ReadBvh, StandsABodyWithoutRootOffsetOnTheFloor) {
  std::string text = kTwoJoints;
  text.replace(text.find("OFFSET 0 10 0"), 13, "OFFSET 0 -90 0");
  const auto read = parse_bvh(text + "0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0 0\n", "a.bvh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_NEAR(
      read->motion.skeleton.joints[0].parent_from_joint.translation.y, 0.9, 1e-12);
}

TEST(ReadBvh, HandsTheTravelOfHipsBelowAHelperRootToTheRoot) {
  const auto path = real_file("bandai/dataset-1_walk_normal_001.bvh");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const auto read = read_bvh(path);
  ASSERT_TRUE(read) << read.error().message();
  const Motion& motion = read->motion;
  const auto hips = motion.skeleton.find("Hips");
  ASSERT_TRUE(hips);
  const auto joints = world_from_joints(motion.skeleton, motion.poses[0]);
  // The first values of the file's Hips.
  EXPECT_LT(glm::distance(joints[index(*hips)].translation,
                          glm::dvec3(-0.0171443, 0.902704, -4.07123)),
            1e-9);
  EXPECT_LT(read->ignored_translation_m, 1e-6);
}

TEST(ReadBvh, ReadsRealFilesOfSeveralDialects) {
  struct Expected {
    const char* file;
    std::size_t joints, frames;
    double hz;
  };
  const auto absent = [](const Expected& e) { return !exists(real_file(e.file)); };
  const std::vector<Expected> files{{"cmu_bvh_tmoco/02_01.bvh", 31, 343, 120.0},
                                    {"cmu_bvh_tmoco/05_06.bvh", 31, 885, 120.0},
                                    {"cmu_bvh_tmoco/arm.bvh", 3, 1, 1.0},
                                    {"cmu_bvh_tmoco/rest.bvh", 31, 1, 24.0},
                                    {"bvh_python/test_freebvh.bvh", 55, 69, 30.0},
                                    {"bvh_python/test_mocapbank.bvh", 19, 455, 30.0}};
  if (std::ranges::any_of(files, absent)) GTEST_SKIP() << "no mocap data here";
  for (const Expected& expected : files) {
    const auto read = read_bvh(real_file(expected.file));
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->motion.skeleton.joints.size(), expected.joints) << expected.file;
    EXPECT_EQ(read->motion.poses.size(), expected.frames) << expected.file;
    EXPECT_NEAR(read->motion.rate.hz, expected.hz, 1e-4) << expected.file;
    EXPECT_EQ(read->ignored_translation_m, 0.0) << expected.file;
  }
}

// Six decimals of a centimetre, and of degrees over a body of 2 m.
TEST(ReadBvh, ReadsRealMotionsAgainInEveryDialect) {
  for (const char* file : {"bandai/dataset-1_walk_normal_001.bvh",
                           "cmu_bvh_tmoco/05_06.bvh",
                           "bvh_python/test_freebvh.bvh",
                           "bvh_python/test_mocapbank.bvh"}) {
    if (!exists(real_file(file))) GTEST_SKIP() << file << " is missing";
    auto real = read_bvh(real_file(file));
    ASSERT_TRUE(real) << real.error().message();
    Motion& motion = real->motion;
    motion.poses.resize(std::min<std::size_t>(motion.poses.size(), 30));
    for (const BvhDialect dialect : {BvhDialect::kBlender,
                                     BvhDialect::kMobu,
                                     BvhDialect::kMaya,
                                     BvhDialect::kUnity}) {
      const BvhWriteOptions options = write_options(dialect);
      const auto read =
          parse_bvh(bvh_text(motion, options), file, {.unit_m = options.unit_m});
      ASSERT_TRUE(read) << read.error().message();
      EXPECT_EQ(read->motion.rate.hz, motion.rate.hz);
      ASSERT_EQ(read->motion.skeleton.joints.size(), motion.skeleton.joints.size());
      for (std::size_t i = 0; i < motion.poses.size(); ++i) {
        const auto a = world_from_joints(motion.skeleton, motion.poses[i]);
        const auto b = world_from_joints(read->motion.skeleton, read->motion.poses[i]);
        for (std::size_t k = 0; k < a.size(); ++k) {
          ASSERT_LT(glm::distance(a[k].translation, b[k].translation), 1e-5)
              << file << " for " << name(dialect);
        }
      }
    }
  }
}

TEST(ReadBvh, NamesTheLineWithAMissingValue) {
  EXPECT_EQ(refusal(kTwoJoints + "0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n"),
            "walk.bvh:20: expected 9 values, found 8. Next: export the file again, or "
            "correct that line in a text editor.");
}

TEST(ReadBvh, NamesTheLineWithAWordAmongTheNumbers) {
  EXPECT_EQ(refusal(kTwoJoints + "0 0 0 0 nan 0 0 0 0\n"),
            "walk.bvh:19: \"nan\" is not a number. Next: export the file again, or "
            "correct that line in a text editor.");
}

TEST(ReadBvh, ReportsHowManyFramesAreMissing) {
  EXPECT_NE(refusal(kTwoJoints + "0 0 0 0 0 0 0 0 0\n")
                .find("walk.bvh:20: expected 2 frames, found 1"),
            std::string::npos);
}

TEST(ReadBvh, RefusesMoreFramesThanAnnounced) {
  const std::string row = "0 0 0 0 0 0 0 0 0\n";
  EXPECT_NE(
      refusal(kTwoJoints + row + row + row)
          .find("walk.bvh:21: there are more values than the declared 2 frames have"),
      std::string::npos);
}

TEST(ReadBvh, ReportsTheLineWhereTheHierarchyEndsEarly) {
  EXPECT_NE(refusal(kTwoJoints.substr(0, kTwoJoints.find("    End Site")))
                .find("walk.bvh:10: the file ends inside the HIERARCHY"),
            std::string::npos);
}

TEST(ReadBvh, RefusesJointsTooDeepForPrograms) {
  const auto chain = [](int joints) {
    const std::string still = "\n{\nOFFSET 0 1 0\nCHANNELS 0\n";
    std::string text = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\n";
    for (int i = 1; i < joints; ++i) text += "JOINT b" + still;
    text += "End Site\n{\nOFFSET 0 1 0\n}\n";
    for (int i = 0; i < joints; ++i) text += "}\n";
    return text + "MOTION\nFrames: 1\nFrame Time: 0.01\n0\n";
  };
  EXPECT_EQ(refusal(chain(1000)), "no refusal");
  EXPECT_NE(refusal(chain(1001)).find("walk.bvh:4002: joints are nested more than"),
            std::string::npos)
      << refusal(chain(1001));
}

TEST(ReadBvh, RefusesAChannelItDoesNotKnow) {
  std::string text = kTwoJoints;
  text.replace(text.find("Zposition"), 9, "Wposition");
  EXPECT_NE(refusal(text).find("walk.bvh:5: unknown channel \"wposition\""),
            std::string::npos);
}

TEST(ReadBvh, GivesChannelsBehindANestedJointToTheJointThatIsOpen) {
  const std::string text =
      "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nJOINT spine\n{\nOFFSET 0 10 0\n"
      "CHANNELS 1 Xrotation\n}\nCHANNELS 3 Xposition Yposition Zposition\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.01\n90 100 200 300\n";
  const auto read = parse_bvh(text, "a.bvh");
  ASSERT_TRUE(read) << read.error().message();
  const Pose& pose = read->motion.poses.at(0);
  EXPECT_LT(glm::distance(pose.root_in_world, glm::dvec3(1, 2, 3)), 1e-12);
  EXPECT_LT(glm::angle(pose.parent_from_joint[0]), 1e-12);
  EXPECT_NEAR(glm::angle(pose.parent_from_joint[1]), std::numbers::pi / 2, 1e-12);
}

TEST(ReadBvh, RefusesTheChannelsOfAJointTwice) {
  std::string text = kTwoJoints;
  text.insert(text.find("  JOINT spine"), "  CHANNELS 1 Xrotation\n");
  EXPECT_NE(refusal(text).find("walk.bvh:6: the joint \"hips\" has its CHANNELS twice"),
            std::string::npos);
}

// Doubles whose squares overflow.
TEST(ReadBvh, RefusesLengthsThatNoBodyHas) {
  std::string text = kTwoJoints;
  text.replace(text.find("OFFSET 0 10 0"), 13, "OFFSET 0 1e200 0");
  EXPECT_NE(refusal(text).find("walk.bvh:8: OFFSET goes further than 10 km"),
            std::string::npos);
  EXPECT_NE(refusal(kTwoJoints + "0 -1e200 0 0 0 0 0 0 0\n")
                .find("walk.bvh:19: a position of \"-1e200\" goes further than 10 km"),
            std::string::npos);
}

TEST(ReadBvh, RefusesAnglesOfWhichOnlyRoundingIsLeft) {
  EXPECT_NE(
      refusal(kTwoJoints + "0 0 0 1e30 0 0 0 0 0\n")
          .find("walk.bvh:19: a rotation of \"1e30\" degrees is more than 1000 turns"),
      std::string::npos);
}

TEST(ReadBvh, RefusesARateThatNoCameraHas) {
  for (const char* time : {"0", "-0.01", "0.0004", "11", "1e-300"}) {
    std::string text = kTwoJoints;
    text.replace(text.find("0.0333333"), 9, time);
    EXPECT_NE(refusal(text).find("walk.bvh:18: Frame Time must be 0.0005 to 10 seconds"),
              std::string::npos)
        << time;
  }
}

TEST(ReadBvh, RefusesAMotionThatAsksForAllMemory) {
  std::string text = "HIERARCHY\nROOT hips\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 2000; ++i) text += "JOINT j\n{\nOFFSET 0 1 0\n}\n";
  text += "}\nMOTION\nFrames: 20000\nFrame Time: 0.01\n";
  for (int i = 0; i < 20000; ++i) text += "0\n";
  EXPECT_NE(refusal(text).find("do not fit into memory"), std::string::npos);
}

TEST(ReadBvh, RefusesAFileOfAnotherKind) {
  EXPECT_NE(refusal("frame,time,joint\n")
                .find("walk.bvh:1: expected \"HIERARCHY\", found \"frame,time,joint\""),
            std::string::npos);
  EXPECT_EQ(refusal(std::string("glTF\2\0\0\0\xff\xfe", 10)),
            "walk.bvh: this is a glTF or VRM file, not a BVH motion. Next: give another "
            "file, or correct the extension of this one.");
  EXPECT_EQ(refusal(""), "walk.bvh: the file is empty. Next: copy or export it again.");
}

TEST(ReadBvh, QuotesNoBytesThatATerminalMustNotReceive) {
  EXPECT_NE(refusal("\x1b[31m\xff\n").find("expected \"HIERARCHY\", found \"?[31m?\""),
            std::string::npos);
}

TEST(ReadBvh, NamesAFileThatIsNotThere) {
  const ScratchFolder folder;
  const auto read = read_bvh(folder / "none.bvh");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message().find("none.bvh"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
