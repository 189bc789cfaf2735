// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The report's page in a browser.
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "app/report.h"
#include "tests/app/browser.h"
#include "tests/app/sample_report.h"

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

TEST_F(ReportInABrowser, OpensWithoutATrial) {
  const ShownPage shown = show(Report{}, "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::app
