// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey convert` and `marey inspect` on labelled markers.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

ProgramRun marey(const std::vector<std::string>& arguments) {
  return run_program(marey::testing::program(), arguments);
}

/// A C3D of a body that stands for three frames, Z up, in millimetres; its head is not
/// seen in the second.
void write_standing(const fs::path& path) {
  recordings::MarkerFile file;
  file.tracks.labels = {"LHEE", "RHEE", "SACR", "HEAD"};
  file.tracks.rate = FrameRate{120.0};
  const std::vector<double> heights{0.04, 0.05, 1.0, 1.7};
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t m = 0; m < 4; ++m) {
      file.tracks.samples.emplace_back(
          MarkerSample{{0.1 * static_cast<double>(m), heights[m], 0.25}, 0.0005F, 3, {}});
    }
  }
  file.tracks.at(1, 3).reset();
  file.events = {{"Foot Strike", "Left", "", 0.01}};
  ASSERT_TRUE(recordings::write_markers(path, file));
}

TEST(Convert, PutsAC3dsMarkersIntoATrcYUp) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun run = marey(
      {"convert", (folder / "a.c3d").string(), (folder / "a.trc").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json figures = Json::parse(run.out);
  EXPECT_EQ(figures.at("markers"), 4);
  EXPECT_EQ(figures.at("frames"), 3);
  EXPECT_EQ(figures.at("up"), "+Y");
  const std::string text = *recordings::read_file(folder / "a.trc");
  EXPECT_NE(text.find("120\t120\t3\t4\tmm\t"), std::string::npos) << text;
  const auto trc = recordings::read_markers(folder / "a.trc");
  ASSERT_TRUE(trc);
  EXPECT_FALSE(trc->tracks.at(1, 3));
  EXPECT_NEAR(trc->tracks.at(2, 3)->p_in_world.y, 1.7, 1e-7);
}

TEST(Convert, KeepsEveryByteFromC3dToC3d) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun run =
      marey({"convert", (folder / "a.c3d").string(), (folder / "b.c3d").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(*recordings::read_file(folder / "a.c3d"),
            *recordings::read_file(folder / "b.c3d"));
}

TEST(Convert, WritesTheRequestedUnitAndAxes) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun run = marey({"convert",
                                (folder / "a.c3d").string(),
                                (folder / "b.c3d").string(),
                                "--to-up",
                                "-X",
                                "--to-unit",
                                "m"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto read = recordings::read_markers(folder / "b.c3d");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->axes.up, recordings::FileAxis::kMinusX);
  EXPECT_EQ(read->axes.unit, "m");
  EXPECT_NEAR(read->tracks.at(0, 3)->p_in_world.y, 1.7, 1e-6);
}

TEST(Convert, StoresTheCorrectedUnitInTheFile) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun run = marey({"convert",
                                (folder / "a.c3d").string(),
                                (folder / "b.c3d").string(),
                                "--unit",
                                "cm"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto read = recordings::read_markers(folder / "b.c3d");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->axes.unit, "cm");
  EXPECT_NEAR(read->tracks.at(0, 3)->p_in_world.y, 17.0, 1e-5);
}

TEST(Convert, ExitsWith3WhenAFileIsNotAMarkerFile) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun other =
      marey({"convert", (folder / "a.c3d").string(), (folder / "a.bvh").string()});
  EXPECT_EQ(other.exit_code, 3);
  ASSERT_TRUE(recordings::write_file(folder / "b.trc", "PathFileType\n"));
  const ProgramRun broken =
      marey({"convert", (folder / "b.trc").string(), (folder / "c.c3d").string()});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_NE(broken.err.find("b.trc:1: the file ends in its header"), std::string::npos)
      << broken.err;
  EXPECT_FALSE(fs::exists(folder / "c.c3d"));
  EXPECT_EQ(marey({"convert", "a.c3d", "b.trc", "--up", "up"}).exit_code, 2);
}

TEST(InspectMarkers, ReportsTheContentsOfAC3d) {
  const ScratchFolder folder;
  write_standing(folder / "a.c3d");
  const ProgramRun run = marey({"inspect", (folder / "a.c3d").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json found = Json::parse(run.out);
  EXPECT_EQ(found.at("kind"), "c3d");
  EXPECT_EQ(found.at("frames"), 3);
  EXPECT_EQ(found.at("rate_hz"), 120.0);
  EXPECT_EQ(found.at("up"), "+Z");
  EXPECT_EQ(found.at("up_from"), "file");
  EXPECT_EQ(found.at("processor"), "intel");
  EXPECT_EQ(found.at("markers")[3].at("label"), "HEAD");
  EXPECT_EQ(found.at("markers")[3].at("seen_frames"), 2);
  EXPECT_EQ(found.at("markers")[0].at("landmark"), "left_heel");
  EXPECT_TRUE(found.at("label_set").is_null());  // Four labels are in many sets.
  EXPECT_EQ(found.at("events")[0].at("context"), "Left");
  EXPECT_TRUE(found.at("force_plates").empty());
  EXPECT_TRUE(found.at("notes").empty());
}

}  // namespace
}  // namespace marey::testing
