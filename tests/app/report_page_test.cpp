// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The report's page in a browser.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "app/report.h"
#include "tests/app/sample_report.h"
#include "tests/support/scratch_folder.h"

namespace marey::app {
namespace {

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
  const testing::ScratchFolder folder;
  std::ofstream(folder / "report.html") << report_html(value);
  const std::string command =
      "cd '" + folder.path().string() + "' && timeout 120 " + kBrowser +
      " --headless --no-sandbox --disable-quic --no-first-run"
      " --disable-background-networking --disable-component-update --disable-sync"
      " --use-angle=swiftshader --enable-unsafe-swiftshader --window-size=1280,900"
      " --enable-logging=stderr --user-data-dir=profile --virtual-time-budget=5000"
      " --dump-dom 'file://" +
      (folder / "report.html").string() + "#" + wishes + "' > page 2> console";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return {text_of(folder / "page"), text_of(folder / "console")};
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
