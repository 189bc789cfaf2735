// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// marey plan, from the outside.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/session/calibration_file.h"
#include "recordings/session/plan_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Plan : public ::testing::Test {
 protected:
  /// Writes plan.toml: cameras in front of a volume of 2 m, and `more`.
  void write_plan(const std::string& more = "", int cameras = 2, int width_px = 1280) {
    std::ofstream out(folder_ / "plan.toml");
    out << "format = 1\n[volume]\nleast_m = [-1, -1]\ngreatest_m = [1, 1]\n"
           "step_m = 0.5\n";
    for (const char* side : {"-1.2", "1.2"}) {
      if (cameras-- == 0) break;
      out << "[[camera]]\nname = \"<b>" << side << "\"\nplace_m = [" << side
          << ", 1.4, 3.0]\nlooks_at_m = [0, 0.9, 0]\nwidth_px = " << width_px
          << "\nheight_px = " << width_px * 9 / 16 << "\nfield_of_view_deg = 70\n";
    }
    out << more;
  }

  [[nodiscard]] ProgramRun plan(std::vector<std::string> more = {},
                                const std::string& out = "out") {
    std::vector<std::string> words{
        "plan", (folder_ / "plan.toml").string(), "--out", (folder_ / out).string()};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(marey::testing::program(), words);
  }

  /// Returns the figures of the last run.
  [[nodiscard]] Json figures() const {
    return Json::parse(read_text(in_folder("out/plan.json")), nullptr, false);
  }

  [[nodiscard]] fs::path in_folder(const std::string& name) const {
    return folder_ / name;
  }

 private:
  ScratchFolder folder_;
};

TEST_F(Plan, ReportsEveryHeightInATableAndInFiles) {
  write_plan();
  const ProgramRun run = plan({"--tag", "90mm", "--height", "2"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"ankle", "hip", "shoulder"}) {
    EXPECT_NE(run.out.find(name), std::string::npos) << run.out;
  }
  const Json json = Json::parse(read_text(in_folder("out/plan.json")), nullptr, false);
  EXPECT_EQ(json.at("tag_size_mm"), 90.0);
  EXPECT_EQ(json.at("places").size(), 75U);
  ASSERT_EQ(json.at("heights").size(), 3U);
  EXPECT_EQ(json.at("heights")[1].at("height_m"), 1.06);
  EXPECT_GT(json.at("heights")[1].at("measured_percent"), 5.0);
  EXPECT_LT(json.at("heights")[1].at("measured_percent"), 50.0);
  EXPECT_GT(json.at("heights")[1].at("tag_median_mm"), 0.05);
  EXPECT_LT(json.at("heights")[1].at("tag_median_mm"), 10.0);
  EXPECT_EQ(json.at("cameras_known"), "planned");
  EXPECT_GT(json.at("cameras")[1].at("centre_sigma_mm"), 0.05);
  EXPECT_LT(json.at("cameras")[1].at("centre_sigma_mm"), 20.0);
  const Json& body = json.at("body");
  EXPECT_EQ(body.at("tags"), 29);
  ASSERT_EQ(body.at("joints").size(), 12U);
  EXPECT_EQ(body.at("joints")[0].at("name"), "left shoulder");
  EXPECT_GT(body.at("median_mm"), 0.2);
  EXPECT_LT(body.at("median_mm"), 20.0);
  EXPECT_NE(run.out.find("right ankle"), std::string::npos) << run.out;
}

TEST_F(Plan, DressesTheBodyInTheTagsOfThePlan) {
  write_plan("[[tag]]\nsegment = \"hips\"\n[[tag]]\nsegment = \"head\"\nsize_m = 0.06\n");
  const ProgramRun run = plan();
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json body = figures().at("body");
  EXPECT_EQ(body.at("tags"), 2);
  // Joints are measured by tags on limbs.
  EXPECT_EQ(body.at("measured_percent"), 0.0);
  EXPECT_GT(body.at("found_percent"), 0.0);
}

TEST_F(Plan, WarnsOfACameraAlone) {
  write_plan("", 1);
  const ProgramRun run = plan();
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(
      run.err.find("plan.toml: one camera alone cannot locate a tag. Next: plan two or "
                   "more"),
      std::string::npos)
      << run.err;
}

TEST_F(Plan, TakesPlannedCamerasAsExactWhereNoBoardIsRead) {
  write_plan("", 2, 320);
  const ProgramRun run = plan();
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(figures().at("cameras_known"), "exactly");
  EXPECT_TRUE(figures().at("cameras")[0].at("centre_sigma_mm").is_null());
  EXPECT_NE(
      run.err.find("they are taken as known exactly. Next: bring camera <b>-1.2 nearer"),
      std::string::npos)
      << run.err;
}

TEST_F(Plan, UsesTheUncertaintyOfCalibratedCameras) {
  // A board cannot be detected in the images of 320 px. The uncertainty is used in both
  // cases.
  for (const int width_px : {1280, 320}) {
    write_plan("", 2, width_px);
    const auto cameras = recordings::read_plan(in_folder("plan.toml"));
    ASSERT_TRUE(cameras);
    CameraQuality known;
    known.centre_sigma_m = 0.004;
    ASSERT_TRUE(recordings::write_calibration(in_folder("plan.toml"),
                                              {cameras->cameras,
                                               {known, known},
                                               std::vector<recordings::CameraClock>(2),
                                               0.1}));
    const ProgramRun run = plan({"--tag", "200mm"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(figures().at("cameras_known"), "calibrated");
    for (const Json& camera : figures().at("cameras")) {
      EXPECT_EQ(camera.at("centre_sigma_mm"), 4.0) << width_px;
    }
    EXPECT_EQ(run.err.find("the errors of each camera are taken as independent") !=
                  std::string::npos,
              width_px == 320)
        << run.err;
  }
}

TEST_F(Plan, DrawsAPageThatNeedsNothingElse) {
  write_plan();
  EXPECT_EQ(plan().exit_code, 0);
  const std::string page = read_text(in_folder("out/plan.html"));
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("&lt;b&gt;-1.2"), std::string::npos);
  for (const char* not_there :
       {"<b>", "http:", "https:", "src=", "<script", " nan", ">nan"}) {
    EXPECT_EQ(page.find(not_there), std::string::npos) << not_there;
  }
}

TEST_F(Plan, WritesTheSameBytesAgain) {
  write_plan();
  EXPECT_EQ(plan({"--json"}, "a").out, plan({"--json"}, "b").out);
  for (const char* name : {"plan.json", "plan.html"}) {
    EXPECT_EQ(read_text(in_folder("a") / name), read_text(in_folder("b") / name)) << name;
  }
  EXPECT_EQ(plan({"--json"}).out, read_text(in_folder("a/plan.json")));
}

TEST_F(Plan, RejectsUnusableInput) {
  write_plan("height_m = 2\n");
  const ProgramRun unknown = plan();
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_NE(unknown.err.find("plan.toml:20: unknown key \"height_m\" in [[camera]]"),
            std::string::npos)
      << unknown.err;
  EXPECT_FALSE(fs::exists(in_folder("out")));
  write_plan();
  EXPECT_EQ(plan({"--tag", "90"}).exit_code, 2);
  EXPECT_EQ(plan({"--height", "90"}).exit_code, 2);
}

}  // namespace
}  // namespace marey::testing
