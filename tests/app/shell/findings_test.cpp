// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/shell/findings.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

std::vector<Finding> findings() {
  return {
      {Severity::kNote, "warp", "board", "it is bent by 1 mm", ""},
      fair_finding("views", "camera left", "it sees 30 views"),
      tolerated(Severity::kPoor,
                "missing",
                bad_input("right.mp4", "it cannot be read", "copy it again")),
      poor_finding("tilt", "camera right", "all views are frontal", "tilt the board")};
}

TEST(Findings, LastPoorOneDeterminesTheExitCode) {
  Console console(ProgressStyle::kQuiet);
  std::vector<Finding> all = findings();
  EXPECT_EQ(print_failures(console, all), Exit::kQualityGate);
  all.pop_back();
  EXPECT_EQ(print_failures(console, all), Exit::kBadInput);
  all.pop_back();
  EXPECT_EQ(print_failures(console, all), Exit::kOk);
}

TEST(Findings, AreListedBySeverity) {
  EXPECT_EQ(messages(findings(), Severity::kPoor),
            (std::vector<std::string>{
                "right.mp4: it cannot be read. Next: copy it again.",
                "camera right: all views are frontal. Next: tilt the board."}));
  EXPECT_EQ(messages(findings(), Severity::kFair).size(), 3U);
}

TEST(Findings, HaveTheKeysOfCalibrationJson) {
  const auto json = findings_json(findings());
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[1].dump(),
            R"({"severity":"fair","kind":"views","where":"camera left",)"
            R"("cause":"it sees 30 views","next":""})");
}

TEST(Findings, HaveTheirValueInJsonIfTheyHaveOne) {
  Finding finding = fair_finding("views", "camera left", "it sees 30 views");
  finding.measured(30.00049, 40.0, "instants");
  EXPECT_EQ(findings_json({&finding, 1})[0].dump(),
            R"({"severity":"fair","kind":"views","where":"camera left",)"
            R"("cause":"it sees 30 views","next":"",)"
            R"("value":30.0,"limit":40.0,"unit":"instants"})");
  finding.measured(0.25, std::nullopt, "m");
  EXPECT_FALSE(findings_json({&finding, 1})[0].contains("limit"));
}

}  // namespace
}  // namespace marey::app
