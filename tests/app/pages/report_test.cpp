// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/pages/base64.h"
#include "core/pose.h"
#include "tests/app/pages/sample_report.h"

namespace marey::app {
namespace {

using nlohmann::json;

json parsed(const Report& value) {
  return json::parse(report_json_text(value));
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

TEST(ReportJson, NamesTheWorstCameraTagFrameAndJoint) {
  Report extended = report();
  ReportTrial& trial = extended.trials.front();
  ASSERT_FALSE(trial.tags.empty());
  trial.tags.back().median_px = 3.25;
  trial.tags.back().rms_px = 4.5;
  trial.tags.back().corners = 40;
  trial.cameras.back().rms_px = 7.5;
  trial.cameras.back().corners = 100;
  trial.first_frame = 10;
  trial.frame_rms_px.at(3) = 40.25;
  constexpr std::size_t kJoint = 4;
  for (auto& frame : trial.bodies.front().uncertainty) {
    if (frame.size() > kJoint) frame[kJoint].sigma_m = 0.345;
  }
  extended.findings.push_back(
      poor_finding("tag", "", "tag 7 does not move with its segment", ""));
  const json summary = parsed(extended).at("summary");
  const json& worst = summary.at("worst");
  EXPECT_EQ(worst.at("camera").at("trial"), trial.name);
  EXPECT_EQ(worst.at("camera").at("name"), trial.cameras.back().name);
  EXPECT_EQ(worst.at("camera").at("value"), 7.5);
  EXPECT_EQ(worst.at("tag").at("name"), trial.tags.back().id);
  EXPECT_EQ(worst.at("tag").at("segment"), trial.tags.back().segment);
  EXPECT_EQ(worst.at("tag").at("value"), 3.25);
  EXPECT_EQ(parsed(extended).at("trials")[0].at("tags").back().at("rms_px"), 4.5);
  EXPECT_EQ(worst.at("frame").at("name"), 13);
  EXPECT_EQ(worst.at("frame").at("value"), 40.25);
  EXPECT_EQ(worst.at("joint").at("name"),
            trial.bodies.front().motion.skeleton.joints[kJoint].name);
  EXPECT_EQ(worst.at("joint").at("value"), 345.0);
  EXPECT_EQ(summary.at("poor"), json({"tag 7 does not move with its segment."}));
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

TEST(ReportJson, ReportsHowOftenAJointWasMeasuredRepairedAndInferred) {
  const json joint = parsed(report()).at("trials")[0].at("joints")[3];
  EXPECT_EQ(joint.at("measured_percent"), 50.0);
  EXPECT_EQ(joint.at("repaired_percent"), 25.0);
  EXPECT_EQ(joint.at("inferred_percent"), 25.0);
}

TEST(ReportJson, ReportsHowLongAGapIsAndHowItWasBridged) {
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

TEST(ReportJson, ReportsThePositionAndDirectionOfACamera) {
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
  EXPECT_LT(report_json_text(report()).size(), 60000u);
}

TEST(ReportJson, IsCompleteForAnEmptyReport) {
  const json figures = parsed(Report{});
  EXPECT_EQ(figures.at("summary").at("solved_percent"), 0.0);
  EXPECT_TRUE(figures.at("trials").empty());
}

TEST(ReportJsonDeathTest, RejectsANonFiniteNumber) {
  Report broken = report();
  broken.calibration_rms_px = std::nan("");
  EXPECT_DEATH((void)report_json_text(broken), "isfinite");
}

TEST(ReportHtml, LetsNoNameBecomeMarkup) {
  const std::string html = report_html(report());
  EXPECT_EQ(html.find("<b>x"), std::string::npos);
  EXPECT_EQ(page_data(html).at("figures").at("session"), kHostile);
}

TEST(ReportHtml, NeedsNothingFromElsewhere) {
  const std::string html = report_html(report());
  // Names of XML namespaces are no addresses: nothing is fetched from them.
  const std::string names = "http://www.w3.org/";
  std::size_t addresses = 0;
  for (std::size_t at = html.find("://"); at != std::string::npos;
       at = html.find("://", at + 1)) {
    if (html.substr(at - 4, names.size()) != names) ++addresses;
  }
  EXPECT_EQ(addresses, 0u);
  EXPECT_EQ(html.find(" src="), std::string::npos);
  EXPECT_EQ(html.find("<link rel=\"stylesheet"), std::string::npos);
}

TEST(ReportHtml, HasAPlaceForEverySection) {
#ifdef MAREY_PLAIN_PAGES
  GTEST_SKIP() << "built with -DMAREY_VIEWER=OFF, without the pages of the reports";
#endif
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

}  // namespace
}  // namespace marey::app
