// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/mot.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

const std::string kHead =
    "Coordinates\nversion=1\nnRows=2\nnColumns=4\ninDegrees=yes\n\n"
    "Units are S.I. units (second, meters, Newtons, ...)\n\nendheader\n";
const std::string kTable =
    "time\tknee_angle_r\tknee_angle_r_beta\tpelvis_ty\n"
    "0.00\t90\t1.5\t0.9\n"
    "0.01\t-45\t1.5\t1e-1\n";

MotTable read(const std::string& text) {
  auto table = parse_mot(text, "a.mot");
  EXPECT_TRUE(table) << table.error().message();
  return table ? *std::move(table) : MotTable{};
}

std::string mot_refusal(const std::string& text) {
  const auto table = parse_mot(text, "a.mot");
  return table ? "no refusal" : table.error().message();
}

TEST(Mot, AnglesBecomeRadiansAndEverythingElseStays) {
  const MotTable table = read(kHead + kTable);
  EXPECT_EQ(table.name, "Coordinates");
  ASSERT_EQ(table.rows(), 2U);
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.time_s[1], 0.01);
  EXPECT_TRUE(table.columns[0].is_angle);
  EXPECT_DOUBLE_EQ(table.at(0, 0), 90.0 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(table.at(1, 0), -45.0 * kRadiansPerDegree);
  // OpenSim writes the rotation of the knee cap in radians.
  EXPECT_EQ(table.at(0, 1), 1.5);
  EXPECT_EQ(table.at(1, 2), 0.1);
  EXPECT_TRUE(table.notes.empty()) << table.notes[0];
}

TEST(Mot, TakesTheAngleUnitFromTheHeaderOrItsAge) {
  const std::string rows = "time pelvis_tilt\n0 180\n";
  const auto tilt = [&](const std::string& head) {
    return read(head + "endheader\n" + rows).at(0, 0);
  };
  EXPECT_EQ(tilt("a\nversion=1\ninDegrees=no\n"), 180.0);
  EXPECT_EQ(tilt("a\nversion=1\n"), 180.0);
  EXPECT_DOUBLE_EQ(tilt("a\nversion=1\ninDegrees = YES\n"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(tilt("name a\ndatacolumns 2\ndatarows 1\nrange 0 1\n"),
                   std::numbers::pi);
}

TEST(Mot, StatesOfAModelAreFoundByTheirCoordinates) {
  const MotTable table = read(
      "s\nversion=1\ninDegrees=no\nendheader\n"
      "time\t/jointset/hip_r/hip_flexion_r/value\t/jointset/hip_r/hip_flexion_r/speed\n"
      "0\t0.5\t2\n");
  EXPECT_EQ(table.find("hip_flexion_r"), 0U);
  EXPECT_EQ(table.find("hip_flexion_l"), std::nullopt);
  EXPECT_TRUE(table.columns[0].is_angle);
  EXPECT_TRUE(table.columns[1].is_angle);
  EXPECT_FALSE(is_rotation("pelvis_tx"));
  EXPECT_FALSE(is_rotation("knee_angle"));
}

TEST(Mot, LineEndsBlankLinesAndBlanksDoNotMatter) {
  for (const std::string end : {"\r\n", "\r", "\n\n", " \t\n"}) {
    std::string other = "\xEF\xBB\xBF";
    for (const char c : kHead + kTable) other += c == '\n' ? end : std::string(1, c);
    const MotTable table = read(other);
    ASSERT_EQ(table.rows(), 2U);
    EXPECT_EQ(table.at(1, 2), 0.1);
    EXPECT_TRUE(table.notes.empty());
  }
}

TEST(Mot, TheTimeMayBeAnyColumn) {
  const MotTable table = read("a\nendheader\n\tpelvis_ty\tTime\tx\t\n1\t0.5\t2\n");
  EXPECT_EQ(table.time_s[0], 0.5);
  EXPECT_EQ(table.at(0, 0), 1.0);
  EXPECT_EQ(table.at(0, 1), 2.0);
  EXPECT_EQ(table.columns[1].name, "x");
}

TEST(Mot, ReadsEverySpellingOfNaN) {
  const MotTable table = read("a\nendheader\ntime a b c\n0 NaN -nan(ind) 1.#QNAN\n");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(table.at(0, i)));
}

TEST(Mot, ReportsCountsThatDifferFromTheHeader) {
  const MotTable table = read("a\nnRows=9\nnColumns=9\nendheader\ntime x\n0 1\n");
  ASSERT_EQ(table.notes.size(), 2U);
  EXPECT_EQ(table.notes[0], "the header has another number of rows than there are, 1");
}

TEST(Mot, IsReadAsItWasWritten) {
  MotTable table;
  table.name = "endheader of a walk";
  table.columns = {{"hip_flexion_l", true}, {"pelvis_tx", false}, {"a b", false}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    table.time_s.push_back(i / 60.0);
    table.values.insert(table.values.end(),
                        {std::sin(0.1 * i), 1e-7 / (i + 1), i == 50 ? nan : 1e300 / 3});
  }
  const std::string text = mot_text(table);
  const MotTable again = read(text);
  EXPECT_EQ(again.name, table.name);
  EXPECT_EQ(again.time_s, table.time_s);
  EXPECT_EQ(again.columns[2].name, "a.b");
  for (std::size_t row = 0; row < 100; ++row) {
    // 12 digits of up to 57 degrees.
    EXPECT_NEAR(again.at(row, 0), table.at(row, 0), 1e-11);
    EXPECT_EQ(again.at(row, 1), table.at(row, 1));
    EXPECT_EQ(std::isnan(again.at(row, 2)), row == 50);
  }
  // Reading and writing again changes nothing: no drift from file to file.
  MotTable third = again;
  third.name = table.name;
  EXPECT_EQ(mot_text(third), text);
}

TEST(Mot, GoesThroughAFile) {
  const testing::ScratchFolder folder;
  const MotTable table = read(kHead + kTable);
  ASSERT_TRUE(write_mot(folder / "a.mot", table));
  const auto again = read_mot(folder / "a.mot");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(mot_text(*again), mot_text(table));
  EXPECT_FALSE(read_mot(folder / "no.mot"));
}

TEST(Mot, BrokenFilesAreRefusedWithTheLine) {
  EXPECT_EQ(mot_refusal(""),
            "a.mot:1: this is not a .mot or .sto file: there is no line endheader. Next: "
            "give a motion or storage file as OpenSim writes it.");
  EXPECT_EQ(mot_refusal("a\nendheader\n\n"),
            "a.mot:3: the file ends after its header. Next: export the file again from "
            "OpenSim.");
  EXPECT_EQ(mot_refusal("a\nendheader\nframe x\n"),
            "a.mot:3: no column is called time; the columns begin with \"frame\". Next: "
            "name the column of times \"time\", or export the file again.");
  EXPECT_EQ(mot_refusal("a\nendheader\ntime x y\n0 1 2\n1 2\n"),
            "a.mot:5: the row has 2 numbers, and there are 3 columns. Next: correct the "
            "line, or export the file again.");
  EXPECT_EQ(mot_refusal("a\nendheader\ntime x\n0 1,5\n"),
            "a.mot:4: \"1,5\" is not a number. Next: correct the line, or export the "
            "file again.");
  EXPECT_EQ(mot_refusal("a\nendheader\ntime x\n1 1\n0.5 1\n"),
            "a.mot:5: the time runs backwards. Next: sort the rows by time.");
  EXPECT_EQ(mot_refusal("a\nendheader\ntime x\nnan 1\n"),
            "a.mot:4: the time is not a number. Next: export the file again from "
            "OpenSim.");
  EXPECT_EQ(mot_refusal("a\ninDegrees=perhaps\nendheader\ntime x\n"),
            "a.mot:2: inDegrees is \"perhaps\". Next: write yes or no there.");
  EXPECT_EQ(mot_refusal("DataType=Vec3\nversion=3\nendheader\ntime x\n0 1,2,3\n"),
            "a.mot:1: the cells hold \"Vec3\", not single numbers. Next: export the "
            "table flattened, one number to a cell.");
}

class RealMot : public ::testing::Test {
 protected:
  static MotTable read_real(const std::string& name) {
    const auto table = read_mot(folder() / name);
    EXPECT_TRUE(table) << table.error().message();
    return table ? *table : MotTable{};
  }
  static fs::path folder() { return marey::testing::shared_data() / "mocap"; }
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << folder() << " is not there";
  }
};

TEST_F(RealMot, EveryFileOfOtherProgramsIsReadAndWrittenAgain) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder())) {
    const std::string ending = entry.path().extension();
    if (ending != ".mot" && ending != ".sto") continue;
    const auto table = read_mot(entry.path());
    ASSERT_TRUE(table) << table.error().message();
    EXPECT_GT(table->rows(), 0U) << entry.path();
    const auto again = parse_mot(mot_text(*table), "again.mot");
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(again->rows(), table->rows()) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 18);
}

TEST_F(RealMot, HeadersOfOpenSimAndOfSimmSayTheSame) {
  const MotTable now = read_real("addbiomechanics/Expert2/run0350cms.mot");
  EXPECT_EQ(now.rows(), 836U);
  EXPECT_EQ(now.columns.size(), 35U);
  EXPECT_NEAR(
      now.at(0, *now.find("knee_angle_r")), 62.62349413 * kRadiansPerDegree, 1e-9);
  EXPECT_EQ(now.at(0, *now.find("knee_angle_r_beta")), 1.09298616);
  EXPECT_EQ(now.at(0, *now.find("pelvis_ty")), 1.08730141);
  EXPECT_TRUE(now.notes.empty());
  const MotTable old = read_real(
      "opensim-core/Applications/IK/tests/resources/std_subject01_walk1_ik.mot");
  EXPECT_EQ(old.rows(), 73U);
  EXPECT_NEAR(
      old.at(0, *old.find("knee_angle_r")), -55.15907196 * kRadiansPerDegree, 1e-9);
  EXPECT_TRUE(old.notes.empty());
}

TEST_F(RealMot, ReportsFewerRowsThanTheHeaderStates) {
  const MotTable table = read_real("opensim-models/Hamner/subject02_running_grf.mot");
  EXPECT_EQ(table.rows(), 601U);
  ASSERT_EQ(table.notes.size(), 1U);
  EXPECT_NE(table.notes[0].find("than there are, 601"), std::string::npos);
}

TEST_F(RealMot, AFileThatWasCutShortIsRefused) {
  const auto text = read_file(folder() / "addbiomechanics/Expert2/run0900cms.mot");
  ASSERT_TRUE(text);
  const auto cut = parse_mot(std::string_view(*text).substr(0, 100'000), "run.mot");
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message().find("columns. Next: correct the line"),
            std::string::npos)
      << cut.error().message();
}

}  // namespace
}  // namespace marey::recordings
