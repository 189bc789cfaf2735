// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey fit` on input that needs a word, or cannot be used.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/marker_file.h"
#include "recordings/session/subject_file.h"
#include "tests/app/labelled_session.h"
#include "tests/support/bodies/worn_markers.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

TEST(FitProgram, ReadsLabelsThroughTheMarkerMap) {
  const ScratchFolder folder;
  const Body person = labelled_person();
  MarkerTracks tracks = film_markers(person, standing(person), {20, 100.0, 3e-4});
  std::string map = "[markers]\n";
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    const std::string label = std::string("Q").append(std::to_string(100 + m));
    for (const auto& [before, name] : worn_on_each_side()) {
      for (const auto& [letter, side] : {std::pair("L", "left_"), {"R", "right_"}}) {
        if (tracks.labels[m] != std::string(letter) + before) continue;
        map += label + " = \"" + side + name + "\"\n";
      }
    }
    tracks.labels[m] = label;
  }
  map += "Q100 = \"ignore\"\n";
  write_tracks(folder / "walk.trc", tracks);
  ASSERT_TRUE(recordings::write_file(folder / "map.toml", map));
  const std::string in = (folder / "walk.trc").string();
  const std::string out = (folder / "out").string();
  ProgramRun run = fit({in, "--out", out});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("walk.trc: no label is known: \"Q100\", "), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("--markers MAP.toml"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
  run = fit({in, "--out", out, "--markers", (folder / "map.toml").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json figures = Json::parse(run.out);
  EXPECT_EQ(figures["labels"][0]["why"], "is to be ignored");
}

TEST(FitProgram, CallsTrialsOfOneNameApart) {
  const ScratchFolder folder;
  const fs::path a = write_static(folder, "a/pose.c3d");
  const fs::path b = write_static(folder, "b/pose.c3d");
  const fs::path out = folder / "out";
  ProgramRun run = fit({a.string(), b.string(), "--out", out.string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(fs::exists(out / "pose/motion.bvh"));
  EXPECT_TRUE(fs::exists(out / "pose-2/motion.bvh"));
  run = fit({a.string(), a.string(), "--out", out.string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("this file is given twice"), std::string::npos) << run.err;
  run = fit({(out / "pose/markers.c3d").string(), "--out", (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  run = fit({(out / "markers/markers.c3d").string(), "--out", out.string()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("would be written over this file"), std::string::npos)
      << run.err;
}

TEST(FitProgram, UnitesTheLabelsOfASubjectOfManyNames) {
  const ScratchFolder folder;
  const Body person = labelled_person();
  std::vector<std::string> arguments;
  for (const std::string subject : {"Ann_static", "Ann"}) {
    MarkerTracks tracks = film_markers(person, standing(person), {20, 100.0, 3e-4});
    for (std::string& label : tracks.labels) label = subject + ":" + label;
    write_tracks(folder / (subject + ".c3d"), tracks);
    arguments.push_back((folder / (subject + ".c3d")).string());
  }
  arguments.insert(arguments.end(), {"--json", "--out", (folder / "out").string()});
  const ProgramRun run = fit(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json figures = Json::parse(run.out);
  EXPECT_EQ(figures["subject"], "Ann_static");
  EXPECT_EQ(figures["labels"].size(), person.markers.size());
  EXPECT_EQ(figures["trials"][1]["prefix"], "Ann:");
  EXPECT_EQ(figures["trials"][1]["frames_solved"], 20);
  const auto read = recordings::read_markers(folder / "out/Ann/markers.c3d");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_TRUE(read->tracks.labels[0].starts_with("Ann:"));
}

TEST(FitProgram, SolvesOneFrame) {
  const ScratchFolder folder;
  const Body person = labelled_person();
  write_tracks(folder / "one.trc",
               film_markers(person, standing(person), {1, 100.0, 3e-4}));
  const ProgramRun run =
      fit({(folder / "one.trc").string(), "--out", (folder / "out").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto [median, maximum] =
      joint_errors(folder / "out/one/joints.csv", person, standing(person));
  // From landmarks and proportions alone, of a person who is not average.
  EXPECT_LT(median, 0.025);
  EXPECT_LT(maximum, 0.060);
}

TEST(FitProgram, NoticesThatLeftIsRight) {
  const ScratchFolder folder;
  const Body person = labelled_person();
  MarkerTracks tracks = film_markers(person, walking(person), {100, 100.0, 3e-4});
  for (std::string& label : tracks.labels) {
    if (label[0] == 'L') {
      label[0] = 'R';
    } else if (label[0] == 'R') {
      label[0] = 'L';
    }
  }
  write_tracks(folder / "walk.trc", tracks);
  const ProgramRun run =
      fit({(folder / "walk.trc").string(), "--out", (folder / "out").string()});
  EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4) << run.exit_code << run.err;
  EXPECT_NE(run.err.find("left and right seem exchanged"), std::string::npos) << run.err;
}

TEST(FitProgram, DeclinesABodyThatHangsHeadDown) {
  const ScratchFolder folder;
  const fs::path in = write_static(folder, "pose.trc");
  const ProgramRun run =
      fit({in.string(), "--up", "-Y", "--out", (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("the body is head down all the time"), std::string::npos)
      << run.err;
}

TEST(FitProgram, RejectsUnusableInput) {
  const ScratchFolder folder;
  const fs::path in = write_static(folder, "pose.trc");
  const std::string out = (folder / "out").string();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    arguments.insert(arguments.end(), {"--out", out});
    const ProgramRun run = fit(arguments);
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
    // One error, and nothing is left behind.
    EXPECT_EQ(run.err.find("error: "), run.err.rfind("error: ")) << run.err;
    EXPECT_FALSE(fs::exists(out));
  };
  ASSERT_TRUE(recordings::write_file(folder / "bad.c3d", "not a C3D"));
  refused({in.string(), (folder / "bad.c3d").string()}, "bad.c3d");
  refused({(folder / "none.trc").string()}, "none.trc");
  refused({in.string(), "--unit", "m"}, "m tall");
  refused({in.string(), "--subject", in.string()},
          "pose.trc: this is a TRC file of markers, not a TOML file");
  refused({in.string(), "--avatar", in.string()}, "pose.trc");
  MarkerTracks hidden = film_markers(labelled_person(), standing(labelled_person()), {3});
  for (auto& sample : hidden.samples) sample.reset();
  write_tracks(folder / "dark.trc", hidden);
  refused({(folder / "dark.trc").string()}, "no marker is seen in any frame");
  ASSERT_TRUE(recordings::write_subject(folder / "tags.toml", tagged_person()));
  refused({in.string(), "--subject", (folder / "tags.toml").string()},
          "the subject has no markers");
}

TEST(FitProgram, RefusesAFolderThatIsAFile) {
  const ScratchFolder folder;
  const fs::path in = write_static(folder, "pose.trc");
  ASSERT_TRUE(recordings::write_file(folder / "out", "a file"));
  const ProgramRun run = fit({in.string(), "--out", (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_EQ(*recordings::read_file(folder / "out"), "a file");
}

TEST(FitProgram, DetectsThatAnotherSubjectIsGiven) {
  const ScratchFolder folder;
  Body other = labelled_person();
  // The other subject is a third taller.
  for (glm::dvec3& offset : other.proportions.offset_in_parent) offset *= 1.33;
  for (PlacedMarker& marker : other.markers) {
    marker.p_in_segment *= 1.33;
    marker.sigma_m = 0.001;
    marker.stray_m = 0.005;
  }
  ASSERT_TRUE(recordings::write_subject(folder / "other.toml", other));
  const fs::path in = write_static(folder, "pose.trc");
  const ProgramRun run = fit({in.string(),
                              "--subject",
                              (folder / "other.toml").string(),
                              "--out",
                              (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("away from the body (RMS)"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("this is the subject of --subject"), std::string::npos)
      << run.err;
  // The program writes the results for inspection.
  EXPECT_TRUE(fs::exists(folder / "out/pose/motion.bvh"));
}

}  // namespace
}  // namespace marey::testing
