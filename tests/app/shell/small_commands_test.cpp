// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The commands that take no time, and how the program ends.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "recordings/gltf/gltf.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kSample = marey::testing::sample_session();
const fs::path kResults = marey::testing::sample_results() / "once";

ProgramRun marey(const std::vector<std::string>& arguments) {
  return run_program(marey::testing::program(), arguments);
}

/// An empty folder, gone with the test.
class SmallCommand : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path in_folder(const std::string& name) const {
    return folder_ / name;
  }

 private:
  ScratchFolder folder_;
};

using Exit = SmallCommand;
using Inspect = SmallCommand;
using Mannequin = SmallCommand;
using Retarget = SmallCommand;

Json inspected(const fs::path& file) {
  const ProgramRun run = marey({"inspect", file.string(), "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  return Json::parse(run.out, nullptr, false);
}

TEST_F(Inspect, ReportsTheSession) {
  const Json session = inspected(kSample);
  EXPECT_EQ(session.at("kind"), "session");
  EXPECT_EQ(session.at("cameras").size(), 4U);
  EXPECT_EQ(session.at("tags"), 29);
}

TEST_F(Inspect, ReportsTheCalibration) {
  const Json calibration = inspected(kResults / "calibration.toml");
  EXPECT_EQ(calibration.at("kind"), "calibration");
  EXPECT_EQ(calibration.at("cameras").size(), 4U);
}

TEST_F(Inspect, ReportsTheSubject) {
  const Json subject = inspected(kResults / "subject.toml");
  EXPECT_EQ(subject.at("kind"), "subject");
  EXPECT_EQ(subject.at("name"), "S16");
}

TEST_F(Inspect, ReportsJoints) {
  const Json joints = inspected(kResults / "walk/joints.csv");
  EXPECT_EQ(joints.at("kind"), "joints");
  EXPECT_EQ(joints.at("frames"), 90);
}

TEST_F(Inspect, ReportsSegments) {
  const Json segments = inspected(kResults / "walk/segments.csv");
  EXPECT_EQ(segments.at("kind"), "segments");
  EXPECT_EQ(segments.at("frames"), 90);
}

TEST_F(Inspect, ReportsMotions) {
  for (const char* name : {"motion.bvh", "motion.glb", "child.bvh", "giant.glb"}) {
    const Json motion = inspected(kResults / "walk" / name);
    EXPECT_EQ(motion.at("motion").at("frames"), 90) << name;
    EXPECT_NEAR(motion.at("motion").at("rate_hz").get<double>(), 30.0, 1e-3) << name;
    EXPECT_EQ(motion.at("skeleton").at("human_bones").size(), 22U) << name;
  }
}

TEST_F(Inspect, IdentifiesTheReport) {
  EXPECT_EQ(inspected(kResults / "report.json").at("kind"), "report");
}

TEST_F(Inspect, DeclinesAFileOfAnotherKind) {
  const ProgramRun run = marey({"inspect", (kSample / "README.md").string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("README.md: is not a kind of file"), std::string::npos)
      << run.err;
}

TEST_F(Inspect, FailsWhereTheNeutralThatIsGivenDoesNotFit) {
  const std::string motion = (kResults / "walk/motion.bvh").string();
  const ProgramRun late = marey({"inspect", motion, "--neutral", "frame:99999"});
  EXPECT_EQ(late.exit_code, 3);
  EXPECT_EQ(late.out, "");
  EXPECT_NE(late.err.find("give a frame from 0 to 89"), std::string::npos) << late.err;

  const fs::path pipe = in_folder("neutral.bvh");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const ProgramRun piped = marey({"inspect", motion, "--neutral", pipe.string()});
  EXPECT_EQ(piped.exit_code, 3);
  EXPECT_NE(piped.err.find("this is a pipe"), std::string::npos) << piped.err;
}

TEST_F(Mannequin, HasTheGivenStature) {
  const fs::path body = in_folder("body.glb");
  const ProgramRun run = marey({"mannequin", "--height", "1.4", "--out", body.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(inspected(body).at("kind"), "character");
  const auto character = recordings::read_character(body);
  ASSERT_TRUE(character) << character.error().message();
  ASSERT_TRUE(character->mesh);
  const auto height = [](const glm::dvec3& p) { return p.y; };
  const auto [lowest, highest] =
      std::ranges::minmax(character->mesh->p_in_world, {}, height);
  EXPECT_NEAR(lowest.y, 0.0, 0.005);
  EXPECT_NEAR(highest.y - lowest.y, 1.4, 0.01 /* m */);
}

TEST_F(Mannequin, RejectsAMeasureThatIsNotANumber) {
  const auto body = in_folder("body.glb");
  for (const char* option : {"--height", "--arm-ratio", "--girth"}) {
    const ProgramRun run = marey({"mannequin", option, "nan", "--out", body.string()});
    EXPECT_EQ(run.exit_code, 2) << option << ": " << run.err;
    EXPECT_FALSE(std::filesystem::exists(body));
  }
}

TEST_F(Mannequin, IsNotWrittenUnderAnotherKindsName) {
  const auto body = in_folder("body.bvh");
  const ProgramRun run = marey({"mannequin", "--out", body.string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("name the result .glb"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(body));
}

TEST_F(Mannequin, RejectsANegativeHeight) {
  const fs::path body = in_folder("body.glb");
  const ProgramRun run = marey({"mannequin", "--height", "-1", "--out", body.string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_FALSE(fs::exists(body));
}

// process writes AVATAR.bvh by the same verb from the same motion, but in memory: BVH
// rounds to a micrometre or so.
TEST_F(Retarget, PutsAWrittenMotionOnABody) {
  const fs::path out = in_folder("walker.bvh");
  const ProgramRun run = marey({"retarget",
                                (kResults / "walk/motion.bvh").string(),
                                "--avatar",
                                marey::testing::sample_results() / "avatars/child.glb",
                                "--out",
                                out.string(),
                                "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Json::parse(run.out, nullptr, false).is_object()) << run.out;
  EXPECT_EQ(inspected(out).at("motion").at("frames"), 90);
}

const char* const kWildBvh =
    "HIERARCHY\nROOT hips\n{\nOFFSET 0 90 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "JOINT spine\n{\nOFFSET 0 10 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "End Site\n{\nOFFSET 0 5 0\n}\n}\nJOINT \xff\n{\nOFFSET 5 0 0\n}\n}\n"
    "MOTION\nFrames: 1\nFrame Time: 0.01\n0 90 0 0 12 0\n";

// Its spine leaves its place by 2 cm, and a joint's name is no UTF-8.
TEST_F(Inspect, ReportsMovementThatIsLeftOut) {
  std::ofstream(in_folder("wild.BVH"), std::ios::binary) << kWildBvh;
  const Json wild = inspected(in_folder("wild.BVH"));
  EXPECT_EQ(wild.at("kind"), "bvh");
  EXPECT_NEAR(wild.at("motion").at("ignored_translation_m").get<double>(), 0.02, 1e-9);
}

TEST_F(Inspect, ShowsNamesThatAreNoUtf8) {
  std::ofstream(in_folder("joints.csv"), std::ios::binary)
      << "frame,time,joint,x,y,z,sigma\n0,0.0,\xff,0,0,0,0\n";
  // U+FFFD replaces a byte that is not valid UTF-8.
  EXPECT_EQ(inspected(in_folder("joints.csv")).at("joints").at(0), "\xEF\xBF\xBD");
  EXPECT_EQ(marey({"inspect", in_folder("joints.csv").string()}).exit_code, 0);
}

TEST_F(Retarget, WarnsOfMovementThatItLeavesOut) {
  std::ofstream(in_folder("wild.bvh"), std::ios::binary) << kWildBvh;
  const ProgramRun run = marey({"retarget",
                                in_folder("wild.bvh").string(),
                                "--avatar",
                                in_folder("none.glb").string(),
                                "--out",
                                in_folder("o.bvh").string(),
                                "--progress",
                                "json"});
  EXPECT_EQ(run.exit_code, 3);
  std::istringstream lines(run.err);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const Json warning = Json::parse(line, nullptr, false);
  ASSERT_TRUE(warning.is_object()) << line;
  EXPECT_NE(warning.at("warning").get<std::string>().find("up to 20 mm"),
            std::string::npos);
  ASSERT_TRUE(std::getline(lines, line));
  const Json error = Json::parse(line, nullptr, false);
  ASSERT_TRUE(error.is_object()) << line;
  EXPECT_EQ(error.at("exit_code"), 3);
  EXPECT_NE(error.at("error").get<std::string>().find("none.glb"), std::string::npos);
}

TEST_F(Exit, IsTwoForACommandThatDoesNotExist) {
  EXPECT_EQ(marey({"proces", kSample.string()}).exit_code, 2);
}

TEST_F(Exit, IsTwoWithoutACommand) {
  EXPECT_EQ(marey({}).exit_code, 2);
}

TEST_F(Exit, IsZeroForHelpWhichGoesToStandardOutput) {
  const ProgramRun run = marey({"--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.out.find("process"), std::string::npos);
  EXPECT_EQ(run.err, "");
}

TEST_F(Exit, IsThreeForASessionThatDoesNotExist) {
  const ProgramRun run = marey(
      {"process", in_folder("nowhere").string(), "--out", in_folder("out").string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_FALSE(fs::exists(in_folder("out")));
}

// No user, root included, can create a folder below a file.
TEST_F(Exit, IsThreeForAPlaceThatCannotHoldResults) {
  std::ofstream(in_folder("file")) << "in the way";
  const ProgramRun run = marey({"mannequin", "--out", in_folder("file/a.glb").string()});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
}

// Before the work begins: finding tags takes minutes.
TEST_F(Exit, IsThreeAtOnceForResultsWhereAFileIs) {
  std::ofstream(in_folder("taken")) << "in the way";
  for (const char* out : {"taken", "taken/below"}) {
    const ProgramRun run = marey({"process",
                                  kSample.string(),
                                  "--out",
                                  in_folder(out).string(),
                                  "--progress",
                                  "json"});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find("is not a folder"), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find("tags in"), std::string::npos) << run.err;
  }
}

// tests/recordings/base/atomic_file_test.cpp tests the removal of partly written files.
// This test cannot detect the moment at which a file is being written.
TEST_F(Exit, Is130WhenInterrupted) {
  const fs::path out = in_folder("out");
  RunOptions options;
  options.interrupt_at = "tags in calib";
  const ProgramRun run = run_program(
      marey::testing::program(),
      {"process", kSample.string(), "--out", out.string(), "--progress", "json"},
      options);
  EXPECT_EQ(run.exit_code, 130) << run.err;
}

}  // namespace
}  // namespace marey::testing
