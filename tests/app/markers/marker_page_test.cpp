// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The pages of labelled markers: OUT.repair.html and fit.html.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "tests/app/browser.h"
#include "tests/app/labelled_session.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/bodies/worn_markers.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_markers.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kHostile = "</script><script>alert(1)</script>";

/// With a gap in M12, frames 100 to 139 of the file, M2 and M17 exchanged in 40, and M6 a
/// metre away in three.
MarkerTracks spoilt_markers() {
  MarkerTracks tracks = synthetic_markers(250);
  for (std::size_t f = 99; f < 139; ++f) tracks.at(f, 12).reset();
  for (std::size_t f = 180; f < 220; ++f) std::swap(tracks.at(f, 2), tracks.at(f, 17));
  for (std::size_t f = 50; f < 53; ++f) tracks.at(f, 6)->p_in_world.y += 1.0;
  return tracks;
}

std::string repaired_page(MarkerTracks tracks) {
  const ScratchFolder folder;
  write_tracks(folder / "a.c3d", std::move(tracks));
  const ProgramRun run = run_program(
      marey::testing::program(),
      {"repair", (folder / "a.c3d").string(), "--out", (folder / "b.c3d").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto page = recordings::read_file(folder / "b.c3d.repair.html");
  EXPECT_TRUE(page);
  return page ? *page : std::string();
}

/// fit.html of a person who stands, with a gap in LTIB and RHEE never seen, and a second
/// trial in which nothing is known of anything but the head.
std::string fitted_page(const ScratchFolder& folder) {
  const Body person = labelled_person();
  MarkerTracks tracks = film_markers(person, standing(person), {60, 100.0, 3e-4});
  const auto column = [&](const char* label) {
    const auto at = std::find(tracks.labels.begin(), tracks.labels.end(), label);
    return static_cast<std::size_t>(at - tracks.labels.begin());
  };
  MarkerTracks bare = tracks;
  for (std::size_t f = 0; f < bare.frames(); ++f) {
    for (std::size_t m = 3; m < bare.markers(); ++m) bare.at(f, m).reset();
  }
  for (std::size_t f = 20; f < 30; ++f) tracks.at(f, column("LTIB")).reset();
  write_tracks(folder / "static.c3d", std::move(tracks));
  write_tracks(folder / "bare.c3d", std::move(bare));
  const ProgramRun run = fit({(folder / "static.c3d").string(),
                              (folder / "bare.c3d").string(),
                              "--out",
                              (folder / "out").string()});
  // The program reports a trial without enough markers.
  EXPECT_EQ(run.exit_code, 3) << run.err;
  const auto page = recordings::read_file(folder / "out/fit.html");
  EXPECT_TRUE(page);
  return page ? *page : std::string();
}

Json data_of(const std::string& page) {
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(start) + start.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

const Json& marker_of(const Json& trial, const std::string& label) {
  const auto& markers = trial["markers"];
  return *std::find_if(markers.begin(), markers.end(), [&](const Json& marker) {
    return marker["label"] == label;
  });
}

TEST(MarkerPage, HasARunForEveryGapAndFault) {
  const Json data = data_of(repaired_page(spoilt_markers()));
  const Json& trial = data["trials"][0];
  const auto fate = [&](const Json& run) {
    return data["fates"][run[2].get<std::size_t>()].get<std::string>();
  };
  const Json& gap = marker_of(trial, "M12");
  ASSERT_EQ(gap["runs"].size(), 1U);
  EXPECT_EQ(gap["runs"][0][0], 99);
  EXPECT_EQ(gap["runs"][0][1], 40);
  EXPECT_TRUE(fate(gap["runs"][0]) == "cluster" || fate(gap["runs"][0]) == "structure");
  EXPECT_EQ(gap["counts"][0], 210);
  for (const char* label : {"M2", "M17"}) {
    const Json& swapped = marker_of(trial, label);
    ASSERT_EQ(swapped["runs"].size(), 1U) << label;
    EXPECT_EQ(fate(swapped["runs"][0]), "swapped");
    EXPECT_EQ(swapped["runs"][0][1], 40);
    EXPECT_EQ(swapped["faults"].size(), 1U);
  }
  // The program removes the leap, and fills the gap.
  const Json& jump = marker_of(trial, "M6");
  ASSERT_EQ(jump["faults"].size(), 1U);
  EXPECT_EQ(jump["faults"][0][0], 50);
  EXPECT_EQ(jump["faults"][0][1], 3);
  // The fault is a metre, less the effect of the leap on the expected place.
  EXPECT_GT(jump["faults"][0][3].get<double>(), 500.0 /* mm */);
  EXPECT_EQ(jump["runs"].size(), 1U);
  EXPECT_TRUE(marker_of(trial, "M0")["runs"].empty());
}

TEST(MarkerPage, ShowsRepairedMarkersBeforeAndAfter) {
  const Json data = data_of(repaired_page(spoilt_markers()));
  const Json& curves = data["trials"][0]["curves"];
  const MarkerTracks truth = synthetic_markers(250);
  ASSERT_EQ(curves.size(), 3U);
  for (const Json& curve : curves) {
    const auto marker = curve["marker"].get<std::size_t>();
    for (std::size_t i = 0; i < curve["at"].size(); ++i) {
      const auto frame = curve["at"][i].get<std::size_t>();
      EXPECT_NEAR(curve["after_mm"][1][i].get<double>(),
                  1e3 * truth.at(frame, marker)->p_in_world.y,
                  0.6 /* the repair's half a millimetre, and rounding */);
    }
  }
  // The longest fill comes first.
  EXPECT_EQ(curves[0]["marker"], 12);
  EXPECT_TRUE(curves[0]["read_mm"][0][40].is_null());
}

TEST(MarkerPage, StaysSmallHoweverLongTheTrial) {
  MarkerTracks tracks = synthetic_markers(6000);
  for (std::size_t f = 100; f < 5900; ++f) tracks.at(f, 12).reset();
  EXPECT_LT(repaired_page(std::move(tracks)).size(), 300'000U);
}

TEST(MarkerPage, HasTheSameBytesTwice) {
  EXPECT_EQ(repaired_page(spoilt_markers()), repaired_page(spoilt_markers()));
  // In one folder: warnings name files by their whole paths.
  const ScratchFolder folder;
  EXPECT_EQ(fitted_page(folder), fitted_page(folder));
}

TEST(MarkerPage, ShowsJointsLabelsAndStills) {
  const ScratchFolder folder;
  const Json data = data_of(fitted_page(folder));
  EXPECT_EQ(data["lengths"].size(), 21U);
  EXPECT_EQ(data["figures"]["joints"].size(), 21U);
  EXPECT_FALSE(data["figures"].contains("seconds"));
  ASSERT_EQ(data["trials"].size(), 2U);
  const Json& trial = data["trials"][0];
  EXPECT_EQ(marker_of(trial, "LTIB")["runs"].size(), 1U);
  EXPECT_EQ(trial["residuals"]["rms_mm"].size(), 60U);
  // Five spread over the trial, and the worst, which may be one of them.
  EXPECT_GE(trial["stills"].size(), 5U);
  for (const Json& still : trial["stills"]) {
    // 22 joints; tips of head, hands and feet.
    EXPECT_EQ(still["joints_mm"].size(), 27U);
    EXPECT_EQ(data["bones"].size(), 26U);
    EXPECT_EQ(still["markers"].size(), trial["markers"].size());
  }
  EXPECT_TRUE(data["trials"][1]["residuals"].is_null());
  EXPECT_TRUE(data["trials"][1]["stills"].empty());
}

using MarkerPageInABrowser = InABrowser;

TEST_F(MarkerPageInABrowser, OpensWithoutAWordOnTheConsole) {
  const ScratchFolder folder;
  for (const std::string& page : {repaired_page(spoilt_markers()), fitted_page(folder)}) {
    const ShownPage shown = show_page(page, "check");
    EXPECT_EQ(shown.status("status"), "ready");
    EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
  }
}

TEST_F(MarkerPageInABrowser, MakesNoElementOutOfALabel) {
  MarkerTracks tracks = spoilt_markers();
  tracks.labels[12] = kHostile;
  const std::string page = repaired_page(std::move(tracks));
  EXPECT_EQ(page.find("alert(1)<"), std::string::npos);
  const ShownPage shown = show_page(page, "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.page.find("<script>alert"), std::string::npos);
  EXPECT_NE(shown.page.find("&lt;script&gt;alert(1)"), std::string::npos);
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

TEST_F(MarkerPageInABrowser, OpensWhenNothingIsToBeRepaired) {
  const ShownPage shown = show_page(repaired_page(synthetic_markers(20)), "check");
  EXPECT_EQ(shown.status("status"), "ready");
  EXPECT_EQ(shown.console.find("CONSOLE"), std::string::npos) << shown.console;
}

}  // namespace
}  // namespace marey::testing
