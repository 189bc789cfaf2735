// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey fit` on a person of ours, whose joints are known.
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/mot.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/subject_file.h"
#include "tests/app/labelled_session.h"
#include "tests/support/bodies/worn_markers.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// static.c3d with the markers inside, range.c3d, walk.trc.
void write_session(const fs::path& folder, const Body& person) {
  const Body moving = without_markers_inside(person);
  write_tracks(folder / "static.c3d",
               film_markers(person, standing(person), {60, 100.0, 3e-4}));
  write_tracks(folder / "range.c3d",
               film_markers(moving, range_of_motion(moving), {800, 100.0, 3e-4}));
  write_tracks(folder / "walk.trc",
               film_markers(moving, walking(moving), {200, 100.0, 3e-4}));
}

std::map<std::string, std::string> files_under(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::string bytes = *recordings::read_file(entry.path());
    if (entry.path().filename() == "fit.json") {
      Json figures = Json::parse(bytes);
      figures.erase("seconds");
      bytes = figures.dump();
    }
    files[fs::relative(entry.path(), folder).string()] = std::move(bytes);
  }
  return files;
}

/// One session, fitted once for all that only look at it.
class FittedSession : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new ScratchFolder;
    person = labelled_person();
    write_session(*folder / ".", person);
    run = fit({inputs()[0],
               inputs()[1],
               inputs()[2],
               "--out",
               (*folder / "out").string(),
               "--stature",
               "1.75",
               "--mass",
               "70",
               "--name",
               "Étienne",
               "--json"});
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }
  static std::vector<std::string> inputs() {
    return {(*folder / "static.c3d").string(),
            (*folder / "range.c3d").string(),
            (*folder / "walk.trc").string()};
  }

  static inline ScratchFolder* folder = nullptr;
  static inline Body person;
  static inline ProgramRun run;
};

TEST_F(FittedSession, FindsTheJoints) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // Places of markers on skin differ by 7 mm from the average's, and 0.3 mm of noise.
  const auto [range_median, max_range] =
      joint_errors(*folder / "out/range/joints.csv", person, range_of_motion(person));
  EXPECT_LT(range_median, 0.010);
  EXPECT_LT(max_range, 0.030);
  const auto [walk_median, max_walk] =
      joint_errors(*folder / "out/walk/joints.csv", person, walking(person));
  EXPECT_LT(walk_median, 0.010);
  EXPECT_LT(max_walk, 0.030);
}

TEST_F(FittedSession, WritesTheSubjectWithItsMarkers) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto body = recordings::read_subject(*folder / "out/subject.toml");
  ASSERT_TRUE(body) << body.error().message();
  EXPECT_EQ(body->name, "Étienne");
  EXPECT_EQ(body->stature_m, 1.75);
  EXPECT_EQ(body->mass_kg, 70.0);
  EXPECT_EQ(body->markers.size(), person.markers.size());
}

TEST_F(FittedSession, WritesEveryFileOfEveryTrial) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const std::string trial : {"static", "range", "walk"}) {
    for (const char* name : {"joints.csv",
                             "segments.csv",
                             "motion.bvh",
                             "motion.glb",
                             "motion.mot",
                             "motion.npz",
                             "markers.c3d",
                             "markers.trc"}) {
      EXPECT_TRUE(fs::exists(*folder / "out" / trial / name)) << trial << " " << name;
    }
  }
  const auto table = recordings::read_mot(*folder / "out/walk/motion.mot");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->columns.size(), 37U);
  EXPECT_EQ(table->rows(), 200U);
  EXPECT_NEAR(table->time_s[100], 1.0, 1e-9);
  const auto rows = recordings::read_joints_csv(*folder / "out/walk/joints.csv");
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->front().frame, 1);
  EXPECT_NEAR(rows->front().time_s, 0.0, 1e-9);
}

TEST_F(FittedSession, ReportsItsFindingsInFitJson) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json figures = Json::parse(run.out);
  EXPECT_EQ(*recordings::read_file(*folder / "out/fit.json"), run.out);
  EXPECT_EQ(figures["label_set"], "Plug-in Gait");
  EXPECT_EQ(figures["labels"].size(), person.markers.size());
  for (const Json& label : figures["labels"]) EXPECT_EQ(label["use"], "named") << label;
  ASSERT_EQ(figures["joints"].size(), static_cast<std::size_t>(kHumanBoneCount - 1));
  for (const Json& joint : figures["joints"]) {
    // Two segments' markers, and a second of bending: no average is needed.
    if (joint["joint"] != "leftLowerArm") continue;
    EXPECT_EQ(joint["origin"], "movement");
    EXPECT_GT(joint["range_deg"], 60.0);
  }
  ASSERT_EQ(figures["trials"].size(), 3U);
  for (const Json& trial : figures["trials"]) {
    EXPECT_LT(trial["rms_mm"], 10.0) << trial["trial"];
    EXPECT_EQ(trial["frames_solved"], trial["frames"]);
    EXPECT_EQ(trial["samples_left_empty"], 0);
  }
}

// Proves that threads and runs do not matter: with one core, trials in another order of
// work, everything but the durations is the same.
TEST_F(FittedSession, GivesTheSameBytesOnOneCore) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::vector<std::string> arguments{"-c", "0", marey::testing::program(), "fit"};
  for (const std::string& input : inputs()) arguments.push_back(input);
  for (const char* word : {"--stature", "1.75", "--mass", "70", "--name", "Étienne"}) {
    arguments.emplace_back(word);
  }
  arguments.insert(arguments.end(), {"--out", (*folder / "again").string()});
  const ProgramRun again = run_program("/usr/bin/taskset", arguments);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(files_under(*folder / "out"), files_under(*folder / "again"));
}

TEST_F(FittedSession, IsSolvedAgainWithTheSubjectItGave) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProgramRun again = fit({inputs()[2],
                                "--subject",
                                (*folder / "out/subject.toml").string(),
                                "--out",
                                (*folder / "reused").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(*recordings::read_file(*folder / "out/walk/joints.csv"),
            *recordings::read_file(*folder / "reused/walk/joints.csv"));
  EXPECT_EQ(*recordings::read_file(*folder / "out/subject.toml"),
            *recordings::read_file(*folder / "reused/subject.toml"));
}

// The skeleton gives the place of a marker that a trial never shows. A marker of a foot
// without any visible marker stays empty.
TEST_F(FittedSession, PredictsMarkersWhereTheirSegmentIsKnown) {
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Body moving = without_markers_inside(person);
  const MarkerTracks truth = film_markers(moving, walking(moving), {200, 100.0, 0.0});
  MarkerTracks tracks = film_markers(moving, walking(moving), {200, 100.0, 3e-4});
  const auto column = [&](const char* label) {
    const auto at = std::find(tracks.labels.begin(), tracks.labels.end(), label);
    return static_cast<std::size_t>(at - tracks.labels.begin());
  };
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    tracks.at(f, column("LTIB")).reset();
    tracks.at(f, column("RHEE")).reset();
    tracks.at(f, column("RTOE")).reset();
  }
  write_tracks(*folder / "bare.c3d", tracks);
  const ProgramRun again = fit({(*folder / "bare.c3d").string(),
                                "--subject",
                                (*folder / "out/subject.toml").string(),
                                "--out",
                                (*folder / "bare").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* name : {"markers.c3d", "markers.trc"}) {
    const auto read = recordings::read_markers(*folder / "bare/bare" / name);
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->tracks.labels, tracks.labels);
    for (std::size_t f = 0; f < tracks.frames(); ++f) {
      EXPECT_FALSE(read->tracks.at(f, column("RHEE"))) << name << f;
      const auto& sample = read->tracks.at(f, column("LTIB"));
      ASSERT_TRUE(sample) << name << " " << f;
      EXPECT_LT(
          glm::distance(sample->p_in_world, truth.at(f, column("LTIB"))->p_in_world),
          0.010 /* m */);
    }
  }
}

}  // namespace
}  // namespace marey::testing
