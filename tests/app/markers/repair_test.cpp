// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey repair` on files of labelled markers.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_markers.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

ProgramRun repair(const fs::path& in, const fs::path& out) {
  return run_program(marey::testing::program(),
                     {"repair", in.string(), "--out", out.string(), "--json"});
}

/// With a gap in M12, frames 100 to 139 of the file, and M2 and M17 exchanged in 40.
void write_spoilt(const fs::path& path) {
  recordings::MarkerFile file;
  // A C3D stores that Z is up. A TRC has no such field, and its default is Y up.
  if (path.extension() == ".trc") file.axes.up = recordings::FileAxis::kPlusY;
  file.tracks = synthetic_markers(250);
  for (std::size_t f = 99; f < 139; ++f) file.tracks.at(f, 12).reset();
  for (std::size_t f = 180; f < 220; ++f) {
    std::swap(file.tracks.at(f, 2), file.tracks.at(f, 17));
  }
  ASSERT_TRUE(recordings::write_markers(path, file));
}

TEST(RepairProgram, FillsGapsAndReportsEverySample) {
  const ScratchFolder folder;
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.c3d", "b.c3d"}, {"a.trc", "b.trc"}, {"a.c3d", "c.trc"}};
  for (const auto& [from, to] : files) {
    const fs::path out = folder / to;
    write_spoilt(folder / from);
    const ProgramRun run = repair(folder / from, out);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto read = recordings::read_markers(out);
    ASSERT_TRUE(read);
    const MarkerTracks truth = synthetic_markers(250);
    double worst_m = 0.0;
    for (std::size_t i = 0; i < truth.samples.size(); ++i) {
      ASSERT_TRUE(read->tracks.samples[i]) << i;
      worst_m = std::max(worst_m,
                         glm::distance(read->tracks.samples[i]->p_in_world,
                                       truth.samples[i]->p_in_world));
    }
    EXPECT_LT(worst_m, 0.0005);
    const Json figures = Json::parse(run.out);
    ASSERT_EQ(figures["gaps"].size(), 1U);
    EXPECT_EQ(figures["gaps"][0]["marker"], "M12");
    EXPECT_EQ(figures["gaps"][0]["first_frame"], 100);
    EXPECT_EQ(figures["gaps"][0]["last_frame"], 139);
    ASSERT_EQ(figures["faults"].size(), 1U);
    EXPECT_EQ(figures["faults"][0]["fault"], "swapped");
    EXPECT_EQ(figures["samples_left_empty"], 0);
    const auto table = recordings::read_file(out.string() + ".repair.csv");
    ASSERT_TRUE(table);
    // Its head, 40 samples of the gap, and 40 of each that was swapped.
    EXPECT_EQ(std::count(table->begin(), table->end(), '\n'), 1 + 40 + 2 * 40);
  }
}

TEST(RepairProgram, DeclinesWithoutLeavingAnything) {
  const ScratchFolder folder;
  write_spoilt(folder / "a.trc");
  ProgramRun run = repair(folder / "a.trc", folder / "a.trc");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("another name"), std::string::npos) << run.err;
  run = repair(folder / "a.trc", folder / "b.bvh");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_FALSE(fs::exists(folder / "b.bvh.repair.json"));
  EXPECT_FALSE(fs::exists(folder / "b.bvh.repair.csv"));
  ASSERT_TRUE(recordings::write_file(folder / "c.c3d", "not a C3D"));
  run = repair(folder / "c.c3d", folder / "d.c3d");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("c.c3d"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "d.c3d"));
}

}  // namespace
}  // namespace marey::testing
