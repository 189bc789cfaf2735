// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey jump`: its command line and its refusals.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "tests/app/jump/jump_scene.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

/// Arguments behind `marey jump` that are refused.
struct RefusedJump {
  std::vector<std::string> more;
  std::string part;  ///< A part of the message.
};

void expect_message(const ProgramRun& run, int exit_code, const std::string& part) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(part), std::string::npos) << part << "\n" << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
  EXPECT_TRUE(run.out.empty()) << run.out;
}

TEST(JumpCommand, AMissingArgumentIsNamed) {
  expect_message(run_program(program(), {"jump"}), 2, "is missing");
  expect_message(
      run_program(program(), {"jump", "--out", "a.bvh"}), 2, "MOTION is missing");
  expect_message(run_program(program(), {"jump", "walk.npz"}), 2, "--out is missing");
}

TEST(JumpCommand, EachValueOutOfRangeIsRefusedWithTheRange) {
  const JumpScene scene;
  const std::vector<std::string> before = scene.files();
  for (const RefusedJump& refused : std::vector<RefusedJump>{
           {{"--apex-by", "20000"}, "--apex-by must be a number from -10000 to 10000"},
           {{"--apex", "0"}, "--apex must be a number from 0.01 to 100, not 0"},
           {{"--apex", "nan"}, "--apex must be a number from 0.01 to 100, not nan"},
           {{"--airtime", "0"}, "--airtime must be a number from 0.02 to 20, not 0"},
           {{"--airtime", "-1"}, "--airtime must be a number from 0.02 to 20, not -1"},
           {{"--length", "-0.1"}, "--length must be a number from 0 to 100"},
           {{"--box", "3000"}, "--box must be a number from -2000 to 2000"},
           {{"--push-time", "0"}, "--push-time must be a number from 0.05 to 10"},
           {{"--push-start", "-1"}, "--push-start must be a number from 0 to"},
           {{"--strength", "0"}, "--strength must be a number from 0.5 to 100"},
           {{"--gravity", "0.4"}, "--gravity must be a number from 0.5 to 30, not 0.4"},
           {{"--gravity", "31"}, "--gravity must be a number from 0.5 to 30, not 31"},
           {{"--law", "magic"}, "--law must be force or thesis, not \"magic\""},
           {{"--jump", "0"}, "--jump must be a whole number from 1 to 10000, not 0"},
           {{"--jump", "1.5"}, "--jump must be a whole number"},
           {{"--land", "1,2"}, "--land must be three numbers"},
           {{"--land", "1,2,3,4"}, "--land must be three numbers"},
           {{"--land", "1,2,inf"}, "--land must be three numbers"},
           {{"--land", "1,2,1e9"}, "--land must be three numbers"},
           {{"--land", "here"}, "--land must be three numbers"}}) {
    expect_message(scene.jump("walk.npz", "out.npz", refused.more), 2, refused.part);
  }
  EXPECT_EQ(scene.files(), before);
}

TEST(JumpCommand, OptionsThatContradictEachOtherAreRefused) {
  const JumpScene scene;
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--apex", "1.4", "--apex-by", "10"},
                                             {"--land", "0,0,1", "--length", "1"},
                                             {"--land", "0,0,1", "--box", "30"},
                                             {"--keep-momentum", "--no-keep-momentum"}}) {
    expect_message(scene.jump("walk.npz", "out.npz", more), 2, "cannot be used together");
  }
}

TEST(JumpCommand, WrongFilesAreRefusedBeforeTheWork) {
  const JumpScene scene;
  ASSERT_TRUE(recordings::write_file(scene / "notes.txt", "no motion"));
  ASSERT_TRUE(recordings::write_file(scene / "empty.bvh", ""));
  const std::vector<std::string> before = scene.files();
  expect_message(scene.jump("gone.npz", "out.npz", {}), 3, "the file does not exist");
  expect_message(scene.jump("empty.bvh", "out.npz", {}), 3, "the file is empty");
  expect_message(scene.jump("notes.txt", "out.npz", {}), 3, "one of these kinds: .bvh");
  expect_message(
      scene.jump("walk.npz", "out.txt", {}), 3, "cannot write a \".txt\" file");
  expect_message(scene.jump("walk.npz", "out", {}), 3, "cannot write a \"\" file");
  expect_message(
      scene.jump("walk.npz", "walk.npz", {}), 3, "the result would replace the motion");
  expect_message(scene.jump("walk.npz", "./walk.npz", {}), 3, "would replace the motion");
  expect_message(scene.jump("walk.npz", "out.npz", {"-c", "gone.toml"}), 3, "gone.toml");
  EXPECT_EQ(scene.files(), before);
}

TEST(JumpCommand, TheCharacterIsNotOverwritten) {
  const JumpScene scene;
  ASSERT_TRUE(recordings::write_file(scene / "ann.toml",
                                     "format = 1\nname = \"Ann\"\nstature_m = 1.7\n"));
  std::filesystem::create_symlink("ann.toml", scene / "ann.npz");
  expect_message(scene.jump("walk.npz", "ann.npz", {"--character", "ann.toml"}),
                 3,
                 "the result would replace --character");
}

TEST(JumpCommand, AMotionWithoutAFlightIsRefused) {
  const JumpScene scene;
  const std::vector<std::string> before = scene.files();
  expect_message(scene.jump("walk.npz", "out.npz", {"--apex-by", "10"}),
                 3,
                 "no time in which nothing bears the body");
  EXPECT_EQ(scene.files(), before);
}

TEST(JumpCommand, ANumberBeyondTheLastJumpIsRefusedWithTheNumberOfJumps) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const ProgramRun run = scene.jump("jump.npz", "out.npz", {"--jump", "3"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find('3'), std::string::npos) << run.err;
  EXPECT_NE(run.err.find('1'), std::string::npos) << run.err;
}

TEST(JumpCommand, WishesThatCannotBeMetAreRefusedWithoutAResult) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  const std::vector<std::string> before = scene.files();
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{
           {"--apex", "0.5"},                     // Below the take-off.
           {"--apex", "90"},                      // Beyond the strength.
           {"--box", "1500", "--apex-by", "1"}})  // Does not get that high.
  {
    const ProgramRun run = scene.jump("jump.npz", "out.npz", more);
    EXPECT_EQ(run.exit_code, 3) << more.front() << ": " << run.err;
    EXPECT_NE(run.err.find("jump.npz: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  }
  EXPECT_EQ(scene.files(), before);
}

TEST(JumpCommand, AFlightThatTheClipCutsHasNoLandingToChange) {
  const JumpScene scene;
  if (!scene.has_jump()) GTEST_SKIP() << "the shared data is absent";
  scene.write_part("cut.npz", 0, 150);  // To 1.25 s, in flight.
  const ProgramRun run = scene.jump("cut.npz", "out.npz", {"--length", "1"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("clip"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(scene / "out.npz"));
}

TEST(JumpCommand, ABodyWithoutLegsIsRefused) {
  const JumpScene scene;
  Motion motion;
  motion.rate.hz = 120.0;
  motion.skeleton.joints.resize(1);
  motion.skeleton.joints[0].name = "hips";
  motion.skeleton.joints[0].bone = HumanBone::kHips;
  Pose pose;
  pose.parent_from_joint.resize(1);
  motion.poses.assign(60, pose);
  ASSERT_TRUE(recordings::write_npz(scene / "stick.npz", motion));
  const ProgramRun run = scene.jump("stick.npz", "out.npz", {"--apex-by", "10"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("stick.npz"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
}

}  // namespace
}  // namespace marey::testing
