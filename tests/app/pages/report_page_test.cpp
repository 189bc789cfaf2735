// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The report's page in a browser.
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "app/pages/report.h"
#include "tests/app/browser.h"
#include "tests/app/pages/sample_report.h"

namespace marey::app {
namespace {

using marey::testing::show_page;
using marey::testing::ShownPage;

ShownPage show(const Report& value, const std::string& wishes) {
  return show_page(report_html(value), wishes);
}

using ReportInABrowser = marey::testing::InABrowser;

TEST_F(ReportInABrowser, OpensWithoutAWordOnTheConsole) {
  const ShownPage shown = show(report(), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

TEST_F(ReportInABrowser, DrawsShadedBodies) {
  const ShownPage shown = show(report(), "check");
  EXPECT_EQ(shown.status("drawing"), "shaded");
  // A floor with its grid alone has about 150.
  EXPECT_GT(std::atoi(shown.status("colours").c_str()), 500);
}

TEST_F(ReportInABrowser, DrawsLinesWhereThereIsNoWebGl) {
  const ShownPage shown = show(report(), "check,lines");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.status("drawing"), "lines");
  // A grid alone has about 5.
  EXPECT_GT(std::atoi(shown.status("colours").c_str()), 20);
}

TEST_F(ReportInABrowser, MakesNoElementOutOfAName) {
  const ShownPage shown = show(report(), "check");
  EXPECT_EQ(shown.page.find("<b>x"), std::string::npos);
}

/// Returns the number of cards at the top that ask to look closer.
int cards_to_look_at(const Report& value) {
  const std::string page = show(value, "check").page;
  const std::string sign = "verdict grade-look-closer";
  int count = 0;
  for (std::size_t at = page.find(sign); at != std::string::npos;
       at = page.find(sign, at + 1)) {
    ++count;
  }
  return count;
}

TEST_F(ReportInABrowser, CallsNoFigureGoodThatOneFrameOrJointSpoils) {
  Report good = report();
  for (ReportTrial& trial : good.trials) {
    if (trial.bodies.empty()) continue;
    for (auto& frame : trial.bodies.front().uncertainty) {
      for (JointUncertainty& joint : frame) joint.sigma_m = 0.004;
    }
  }
  const int usual = cards_to_look_at(good);
  Report spoiled = good;
  spoiled.trials.front().frame_rms_px.at(3) = 40.0;
  EXPECT_EQ(cards_to_look_at(spoiled), usual + 1);
  for (auto& frame : spoiled.trials.front().bodies.front().uncertainty) {
    frame.front().sigma_m = 0.3;
  }
  EXPECT_EQ(cards_to_look_at(spoiled), usual + 2);
  Report warned_about = good;
  warned_about.findings.push_back(poor_finding(
      "subject", "subject.toml", "the tags on segment \"leftFoot\" fit in two ways", ""));
  EXPECT_EQ(cards_to_look_at(warned_about), usual + 3);
}

TEST_F(ReportInABrowser, OpensWithoutATrial) {
  const ShownPage shown = show(Report{}, "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::app
