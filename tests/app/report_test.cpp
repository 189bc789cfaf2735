// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/base64.h"
#include "core/pose.h"
#include "tests/support/synthetic_walk.h"

namespace marey::app {
namespace {

using nlohmann::json;

constexpr const char* kHostile = "</script><b>x</b>&<!--\"'\xE2\x80\xA8";
constexpr int kFrames = 40;

/// A picture of 2 x 2 pixels would do; the page never decodes it in these tests.
const std::string kJpegStart = "\xFF\xD8\xFF\xE0";

ReportBody subject() {
  ReportBody body;
  body.name = "subject";
  body.motion = marey::testing::synthetic_walk(kFrames, 30.0).motion;
  const std::size_t joints = body.motion.skeleton.joints.size();
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto source = frame < 20   ? Source::kMeasured
                        : frame < 30 ? Source::kRepaired
                                     : Source::kInferred;
    body.doubt.emplace_back(joints, JointDoubt{0.001 * (frame + 1), source});
  }
  body.files = {"walk/motion.bvh", "javascript:alert(1)/<b>x.glb"};
  return body;
}

ReportBody avatar(const std::string& name) {
  ReportBody body = subject();
  body.name = name;
  body.doubt.clear();
  body.slide_before_cm_per_s = 12.3456;
  body.slide_after_cm_per_s = 0.1234;
  body.penetration_mm = 1.5;
  return body;
}

ReportTrial trial(const std::string& name) {
  ReportTrial out;
  out.name = name;
  out.rate = {30.0};
  out.first_frame = 5;
  out.frames = kFrames;
  out.frames_solved = 39;
  out.rms_px = 0.51239;
  out.median_px = 0.4;
  out.cameras = {{"left", 0.5, 0.3, 1000, 0.0, true},
                 {kHostile, 0.6, 0.4, 900, 0.00731, false}};
  out.frame_rms_px.assign(kFrames, 0.5);
  out.frame_rms_px[7] = 0.0;
  out.tags = {{41, "hips", std::vector<int>(kFrames, 2)},
              {42, kHostile, std::vector<int>(kFrames, 0)}};
  out.tags[1].cameras_seeing[3] = 1;
  out.gaps = {{"leftFoot", 25, 34, Source::kRepaired},
              {kHostile, 40, 44, Source::kInferred}};
  ReportPicture picture;
  picture.camera = kHostile;
  picture.frame = 12;
  picture.width_px = 640;
  picture.height_px = 360;
  picture.jpeg = kJpegStart;
  picture.bones = {{{10, 20}, {30, 40}, Source::kMeasured},
                   {{30, 40}, {50, 60}, Source::kInferred}};
  picture.tags = {{41, {{1, 2}, {3, 2}, {3, 4}, {1, 4}}}};
  out.pictures = {picture};
  out.bodies = {subject(), avatar(kHostile), avatar("robot")};
  return out;
}

Report report() {
  Report out;
  out.session = kHostile;
  out.version = "0.1.0";
  for (const double x : {-2.0, 2.0}) {
    ReportCamera camera;
    camera.camera.name = x < 0 ? "left" : kHostile;
    camera.camera.intrinsics.width_px = 1280;
    camera.camera.intrinsics.height_px = 720;
    camera.camera.intrinsics.centre_px = {639.5, 359.5};
    // Looks along -Z from x, 1.5, 4: half a turn about X.
    camera.camera.camera_from_world =
        inverse(RigidTransform{{0.0, 1.0, 0.0, 0.0}, {x, 1.5, 4.0}});
    camera.rms_px = 0.21;
    camera.centre_sigma_m = 0.0012;
    camera.focal_sigma_px = 0.8;
    camera.coverage = 0.62;
    camera.views = 51;
    out.cameras.push_back(camera);
  }
  out.calibration_rms_px = 0.2149;
  out.subject.name = kHostile;
  out.subject.stature_m = 1.75;
  out.subject.proportions = average_proportions(1.75);
  out.subject.joint_centre_sigma_m.fill(0.002);
  out.subject.tags = {{{TagId{41}, HumanBone::kHips, 0.09}, {}, 0.0011, 0.01, 77}};
  out.subject_rms_px = 0.44;
  out.limb_ratio = 1.02;
  out.unplaced_tags = {99};
  out.trials = {trial("walk"), trial(kHostile)};
  out.timings = {{"tags", 3.0}, {kHostile, 1.0}};
  out.recorded_s = 2.0;
  out.warnings = {std::string("tag 99 was never seen ") + kHostile};
  return out;
}

json parsed(const Report& value) {
  return json::parse(report_json(value));
}

/// The data that the page's scripts read.
json page_data(const std::string& html) {
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = html.find(start) + start.size();
  return json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(Base64, WritesTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(ReportJson, SumsUpTheTrials) {
  const json summary = parsed(report()).at("summary");
  EXPECT_EQ(summary.at("trials"), 2);
  EXPECT_EQ(summary.at("frames"), 2 * kFrames);
  EXPECT_EQ(summary.at("frames_solved"), 78);
  EXPECT_EQ(summary.at("solved_percent"), 97.5);
  EXPECT_EQ(summary.at("processing_s"), 4.0);
  EXPECT_EQ(summary.at("times_real_time"), 2.0);
}

TEST(ReportJson, RoundsPixelsToThreeDecimalsAndMillimetresToTwo) {
  const json figures = parsed(report());
  EXPECT_EQ(figures.at("calibration").at("rms_px"), 0.215);
  EXPECT_EQ(figures.at("trials")[0].at("rms_px"), 0.512);
  EXPECT_EQ(figures.at("calibration").at("cameras")[0].at("centre_sigma_mm"), 1.2);
  EXPECT_EQ(figures.at("trials")[0].at("cameras")[1].at("offset_ms"), 7.31);
}

TEST(ReportJson, GivesMedianAnd95PercentOfEveryJointsSigma) {
  const json joint = parsed(report()).at("trials")[0].at("joints")[0];
  // Sigmas are 1 to 40 mm.
  EXPECT_EQ(joint.at("joint"), "hips");
  EXPECT_EQ(joint.at("median_sigma_mm"), 21.0);
  EXPECT_EQ(joint.at("p95_sigma_mm"), 38.0);
}

TEST(ReportJson, SaysHowOftenAJointWasMeasuredRepairedAndInferred) {
  const json joint = parsed(report()).at("trials")[0].at("joints")[3];
  EXPECT_EQ(joint.at("measured_percent"), 50.0);
  EXPECT_EQ(joint.at("repaired_percent"), 25.0);
  EXPECT_EQ(joint.at("inferred_percent"), 25.0);
}

TEST(ReportJson, SaysHowLongAGapIsAndHowItWasBridged) {
  const json gap = parsed(report()).at("trials")[0].at("gaps")[0];
  EXPECT_EQ(gap.at("segment"), "leftFoot");
  EXPECT_EQ(gap.at("duration_s"), 0.333);
  EXPECT_EQ(gap.at("bridged_as"), "repaired");
}

TEST(ReportJson, CountsTheFramesInWhichATagWasSeen) {
  const json tags = parsed(report()).at("trials")[0].at("tags");
  EXPECT_EQ(tags[0].at("seen_percent"), 100.0);
  EXPECT_EQ(tags[1].at("seen_frames"), 1);
}

TEST(ReportJson, TellsWhereACameraStandsAndLooks) {
  const json camera = parsed(report()).at("calibration").at("cameras")[0];
  EXPECT_EQ(camera.at("centre_in_world_m"), json({-2.0, 1.5, 4.0}));
  EXPECT_EQ(camera.at("forward_in_world"), json({0.0, 0.0, -1.0}));
}

TEST(ReportJson, KeepsNamesAsTheyAre) {
  EXPECT_EQ(parsed(report()).at("session"), kHostile);
}

TEST(ReportJson, ReplacesBytesThatAreNotUtf8) {
  Report broken = report();
  broken.session = "walk\xFF";
  EXPECT_EQ(parsed(broken).at("session"), "walk\xEF\xBF\xBD");
}

TEST(ReportJson, HoldsNoPicturesAndNoMotions) {
  EXPECT_LT(report_json(report()).size(), 60000u);
}

TEST(ReportJson, OfNothingIsStillWhole) {
  const json figures = parsed(Report{});
  EXPECT_EQ(figures.at("summary").at("solved_percent"), 0.0);
  EXPECT_TRUE(figures.at("trials").empty());
}

TEST(ReportJsonDeathTest, RefusesANumberThatIsNone) {
  Report broken = report();
  broken.calibration_rms_px = std::nan("");
  EXPECT_DEATH((void)report_json(broken), "isfinite");
}

TEST(ReportHtml, LetsNoNameBecomeMarkup) {
  const std::string html = report_html(report());
  EXPECT_EQ(html.find("<b>x"), std::string::npos);
  EXPECT_EQ(page_data(html).at("figures").at("session"), kHostile);
}

TEST(ReportHtml, NeedsNothingFromElsewhere) {
  const std::string html = report_html(report());
  // Names of XML namespaces are no addresses: nothing is fetched from them.
  const std::string svg = "http://www.w3.org/2000/svg";
  std::size_t addresses = 0;
  for (std::size_t at = html.find("://"); at != std::string::npos;
       at = html.find("://", at + 1)) {
    if (html.substr(at - 4, svg.size()) != svg) ++addresses;
  }
  EXPECT_EQ(addresses, 0u);
  EXPECT_EQ(html.find(" src="), std::string::npos);
  EXPECT_EQ(html.find("<link rel=\"stylesheet"), std::string::npos);
}

TEST(ReportHtml, HasAPlaceForEverySection) {
  const std::string html = report_html(report());
  for (const char* section : {"head",
                              "motion",
                              "pictures",
                              "reprojection",
                              "tags",
                              "joints",
                              "subject",
                              "cameras",
                              "avatars",
                              "time"}) {
    EXPECT_NE(html.find("<section id=\"" + std::string(section) + "\">"),
              std::string::npos)
        << section;
  }
}

TEST(ReportHtml, IsTheSameForTheSameReport) {
  EXPECT_EQ(report_html(report()), report_html(report()));
}

/// Number `at` of a base64 text of little-endian int16.
int int16_of(const std::string& text, std::size_t at) {
  const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    const auto digit = [&](std::size_t k) {
      return static_cast<unsigned>(digits.find(text[i / 3 * 4 + k]) & 63U);
    };
    const unsigned group = digit(0) << 18 | digit(1) << 12 | digit(2) << 6 | digit(3);
    return (group >> (16 - 8 * (i % 3))) & 255U;
  };
  return static_cast<std::int16_t>(byte(2 * at) | byte(2 * at + 1) << 8);
}

TEST(ReportHtml, GivesJointsToTheMillimetre) {
  const Report whole = report();
  const Motion& motion = whole.trials[0].bodies[0].motion;
  const json body = page_data(report_html(whole)).at("trials")[0].at("bodies")[0];
  const std::size_t points = body.at("points").size();
  const std::size_t frame = 17;
  const std::size_t joint = index(HumanBone::kLeftHand);
  const auto world = world_from_joints(motion.skeleton, motion.poses[frame]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int value =
        int16_of(body.at("xyz").get<std::string>(), 3 * (frame * points + joint) + axis);
    const double read =
        body.at("origin_m")[axis].get<double>() + body.at("unit_m").get<double>() * value;
    EXPECT_NEAR(read, world[joint].translation[static_cast<int>(axis)], 0.00051 /* m */);
  }
}

TEST(ReportHtml, LeavesOutWhatIsNotPartOfTheFigure) {
  Report whole = report();
  Skeleton& skeleton = whole.trials[0].bodies[1].motion.skeleton;
  const auto head = skeleton.find(HumanBone::kHead);
  const auto hand = skeleton.find(HumanBone::kLeftHand);
  skeleton.joints.push_back({"hair", head, {}, std::nullopt, std::nullopt});
  skeleton.joints.push_back({"thumb", hand, {}, std::nullopt, std::nullopt});
  for (Pose& pose : whole.trials[0].bodies[1].motion.poses) {
    pose.parent_from_joint.resize(skeleton.joints.size(), {1.0, 0.0, 0.0, 0.0});
  }
  const json body = page_data(report_html(whole)).at("trials")[0].at("bodies")[1];
  std::vector<std::string> names;
  for (const json& point : body.at("points")) names.push_back(point.at("name"));
  EXPECT_EQ(std::count(names.begin(), names.end(), "hair"), 0);
  EXPECT_EQ(std::count(names.begin(), names.end(), "thumb"), 1);
}

TEST(ReportHtml, StaysSmall) {
  EXPECT_LT(report_html(report()).size(), 1'000'000u);
}

// --- In a browser ---

constexpr const char* kBrowser = "/usr/bin/chromium";

struct Shown {
  std::string page;     ///< The document after its scripts ran.
  std::string console;  ///< What the browser said.
};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Opens a report in a headless browser; `wishes` are those of app/report/page.js.
Shown show(const Report& value, const std::string& wishes) {
  std::string pattern =
      (std::filesystem::temp_directory_path() / "marey-report-XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(pattern.data());
  std::ofstream(folder / "report.html") << report_html(value);
  const std::string command =
      "cd '" + folder.string() + "' && timeout 120 " + kBrowser +
      " --headless --no-sandbox --disable-quic --no-first-run"
      " --disable-background-networking --disable-component-update --disable-sync"
      " --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=1280,900"
      " --enable-logging=stderr --user-data-dir=profile --virtual-time-budget=5000"
      " --dump-dom 'file://" +
      (folder / "report.html").string() + "#" + wishes + "' > page 2> console";
  EXPECT_EQ(std::system(command.c_str()), 0);
  Shown shown{text_of(folder / "page"), text_of(folder / "console")};
  std::filesystem::remove_all(folder);
  return shown;
}

/// The value of an attribute of <html>.
std::string status(const Shown& shown, const std::string& attribute) {
  const std::string start = "data-" + attribute + "=\"";
  const std::size_t at = shown.page.find(start);
  if (at == std::string::npos) return "";
  const std::size_t from = at + start.size();
  return shown.page.substr(from, shown.page.find('"', from) - from);
}

class ReportInABrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kBrowser)) {
      GTEST_SKIP() << kBrowser << " is missing; apt-get install chromium";
    }
  }
};

TEST_F(ReportInABrowser, OpensWithoutAWordOnTheConsole) {
  const Shown shown = show(report(), "check");
  EXPECT_EQ(status(shown, "status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

TEST_F(ReportInABrowser, DrawsShadedBodies) {
  const Shown shown = show(report(), "check");
  EXPECT_EQ(status(shown, "drawing"), "shaded");
  // A floor with its grid alone has about 150.
  EXPECT_GT(std::atoi(status(shown, "colours").c_str()), 500);
}

TEST_F(ReportInABrowser, DrawsLinesWhereThereIsNoWebGl) {
  const Shown shown = show(report(), "check,lines");
  EXPECT_EQ(status(shown, "status"), "ready");
  EXPECT_EQ(status(shown, "drawing"), "lines");
  // A grid alone has about 5.
  EXPECT_GT(std::atoi(status(shown, "colours").c_str()), 20);
}

TEST_F(ReportInABrowser, MakesNoElementOutOfAName) {
  const Shown shown = show(report(), "check");
  EXPECT_EQ(shown.page.find("<b>x"), std::string::npos);
}

TEST_F(ReportInABrowser, OpensWithoutATrial) {
  const Shown shown = show(Report{}, "check");
  EXPECT_EQ(status(shown, "status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::app
