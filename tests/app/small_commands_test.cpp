// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The commands that take no time, and how the program ends.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/support/run_program.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kSample = MAREY_SAMPLE;
const fs::path kResults = MAREY_FIRST_LIGHT "/once";

ProgramRun marey(const std::vector<std::string>& arguments) {
  return run_program(MAREY_PROGRAM, arguments);
}

/// An empty folder, gone with the test.
class SmallCommand : public ::testing::Test {
 protected:
  SmallCommand() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("marey-" + std::string(test->name()) + "-" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SmallCommand() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  [[nodiscard]] fs::path in_folder(const std::string& name) const {
    return folder_ / name;
  }

 private:
  fs::path folder_;
};

using Exit = SmallCommand;
using Mannequin = SmallCommand;
using Retarget = SmallCommand;

Json inspected(const fs::path& file) {
  const ProgramRun run = marey({"inspect", file.string(), "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  return Json::parse(run.out, nullptr, false);
}

TEST(Inspect, TellsOfTheSession) {
  const Json session = inspected(kSample);
  EXPECT_EQ(session.at("kind"), "session");
  EXPECT_EQ(session.at("cameras").size(), 4U);
  EXPECT_EQ(session.at("tags"), 29);
}

TEST(Inspect, TellsOfTheCalibration) {
  const Json calibration = inspected(kResults / "calibration.toml");
  EXPECT_EQ(calibration.at("kind"), "calibration");
  EXPECT_EQ(calibration.at("cameras").size(), 4U);
}

TEST(Inspect, TellsOfTheSubject) {
  const Json subject = inspected(kResults / "subject.toml");
  EXPECT_EQ(subject.at("kind"), "subject");
  EXPECT_EQ(subject.at("name"), "S16");
}

TEST(Inspect, TellsOfJoints) {
  const Json joints = inspected(kResults / "walk/joints.csv");
  EXPECT_EQ(joints.at("kind"), "joints");
  EXPECT_EQ(joints.at("frames"), 90);
}

TEST(Inspect, TellsOfSegments) {
  const Json segments = inspected(kResults / "walk/segments.csv");
  EXPECT_EQ(segments.at("kind"), "segments");
  EXPECT_EQ(segments.at("frames"), 90);
}

TEST(Inspect, TellsOfMotions) {
  for (const char* name : {"motion.bvh", "motion.glb", "child.bvh", "giant.glb"}) {
    const Json motion = inspected(kResults / "walk" / name);
    EXPECT_EQ(motion.at("motion").at("frames"), 90) << name;
    EXPECT_NEAR(motion.at("motion").at("rate_hz").get<double>(), 30.0, 1e-3) << name;
    EXPECT_EQ(motion.at("skeleton").at("human_bones").size(), 22U) << name;
  }
}

TEST(Inspect, TellsOfTheReport) {
  EXPECT_EQ(inspected(kResults / "report.json").at("kind"), "report");
}

TEST(Inspect, DeclinesAFileOfAnotherKind) {
  const ProgramRun run = marey({"inspect", (kSample / "README.md").string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("README.md: is not a kind of file"), std::string::npos)
      << run.err;
}

TEST(Doctor, FindsWhatThisMachineHas) {
  const ProgramRun run = marey({"doctor", "--json"});
  const Json said = Json::parse(run.out, nullptr, false);
  ASSERT_TRUE(said.is_object()) << run.out;
  EXPECT_EQ(run.exit_code, said.at("good").get<bool>() ? 0 : 5);
  for (const Json& check : said.at("checks")) {
    EXPECT_FALSE(check.at("finding").get<std::string>().empty());
    EXPECT_EQ(check.contains("advice"), !check.at("good").get<bool>());
  }
}

TEST(Doctor, NamesTheVersionThatTheProgramNames) {
  const Json said = Json::parse(marey({"doctor", "--json"}).out, nullptr, false);
  EXPECT_EQ("marey " + said.at("version").get<std::string>() + "\n",
            marey({"--version"}).out);
}

TEST_F(Mannequin, HasTheStatureThatWasAskedFor) {
  const fs::path body = in_folder("body.glb");
  const ProgramRun run = marey({"mannequin", "--height", "1.4", "--out", body.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json character = inspected(body);
  EXPECT_EQ(character.at("kind"), "character");
  EXPECT_GT(character.at("vertices").get<int>(), 500);
}

TEST_F(Mannequin, OfAnImpossibleHeightIsAUsageError) {
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
                                MAREY_FIRST_LIGHT "/avatars/child.glb",
                                "--out",
                                out.string(),
                                "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Json::parse(run.out, nullptr, false).is_object()) << run.out;
  EXPECT_EQ(inspected(out).at("motion").at("frames"), 90);
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

// A folder cannot be made below a file, whoever one is.
TEST_F(Exit, IsThreeForAPlaceThatCannotHoldResults) {
  std::ofstream(in_folder("file")) << "in the way";
  const ProgramRun run = marey({"mannequin", "--out", in_folder("file/a.glb").string()});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("Next: "), std::string::npos) << run.err;
}

TEST_F(Exit, Is130WhenInterruptedAndLeavesNothingHalfWritten) {
  const fs::path out = in_folder("out");
  RunOptions options;
  options.interrupt_at = "tags in calib";
  const ProgramRun run = run_program(
      MAREY_PROGRAM,
      {"process", kSample.string(), "--out", out.string(), "--progress", "json"},
      options);
  EXPECT_EQ(run.exit_code, 130) << run.err;
  if (!fs::exists(out)) return;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
  }
}

}  // namespace
}  // namespace marey::testing
