// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The page of a calibration in a browser.
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "app/pages/calibration_html.h"
#include "tests/app/browser.h"
#include "tests/app/pages/sample_calibration.h"

namespace marey::app {
namespace {

using marey::testing::show_page;
using marey::testing::ShownPage;
using CalibrationInABrowser = marey::testing::InABrowser;

TEST_F(CalibrationInABrowser, OpensWithoutAWordOnTheConsole) {
  const ShownPage shown = show_page(calibration_html(rich_calibration()), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
  EXPECT_NE(shown.page.find("Look closer: do not use these cameras"), std::string::npos);
}

TEST_F(CalibrationInABrowser, MakesNoElementOutOfAName) {
  const ShownPage shown = show_page(calibration_html(rich_calibration()), "check");
  EXPECT_EQ(shown.page.find("<b>x"), std::string::npos);
}

TEST_F(CalibrationInABrowser, DrawsCamerasAndBoards) {
  const ShownPage shown = show_page(calibration_html(sample_calibration()), "check");
  EXPECT_EQ(shown.status("drawing"), "shaded");
  calib::CalibrationReport bare = sample_calibration();
  bare.rig.views.clear();
  const ShownPage without = show_page(calibration_html(bare), "check");
  const int cameras = std::atoi(without.status("colours").c_str());
  // A floor with its grid alone has about 150.
  EXPECT_GT(cameras, 190);
  EXPECT_GT(std::atoi(shown.status("colours").c_str()), cameras + 50);
}

TEST_F(CalibrationInABrowser, DrawsThemWhereThereIsNoWebGl) {
  const ShownPage shown =
      show_page(calibration_html(sample_calibration()), "check,lines");
  EXPECT_EQ(shown.status("drawing"), "lines");
  // A grid alone has about 5.
  EXPECT_GT(std::atoi(shown.status("colours").c_str()), 20);
}

TEST_F(CalibrationInABrowser, OpensWithAMinimalReport) {
  calib::CalibrationReport report = sample_calibration();
  report.extent.reset();
  report.has_floor = false;
  report.rig.views.clear();
  report.rig.shared_views.clear();
  report.rig.covariance.values.clear();
  report.rig.cross_validation.reset();
  report.map.middle_error_m.reset();
  for (auto& camera : report.cameras) camera = {};
  for (auto& place : report.map.places) place.error_m.reset();
  const ShownPage shown = show_page(calibration_html(report), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::app
