// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/read_source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "library/clips/normal_form.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/motion_object.h"
#include "recordings/motion/npz.h"
#include "tests/app/labelled_session.h"
#include "tests/app/library/sources/source_scene.h"
#include "tests/support/bodies/worn_markers.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::source_at;
using testing::write_walk;

std::vector<SourceMotion> motions_of(const fs::path& path,
                                     const ReadSourceOptions& options = {},
                                     const LibrarySource& source = {}) {
  auto all = read_source(source_at(path), source, options);
  EXPECT_TRUE(all) << all.error().message();
  return all ? *std::move(all) : std::vector<SourceMotion>{};
}

std::string refusal_of(const fs::path& path,
                       const ReadSourceOptions& options = {},
                       const LibrarySource& source = {}) {
  const auto all = read_source(source_at(path), source, options);
  return all ? "read" : all.error().message();
}

double figure_of(const SourceMotion& motion, const std::string& name) {
  const auto found = std::ranges::find(motion.figures, name, &ClipFigure::name);
  return found == motion.figures.end() ? NAN : found->value;
}

bool has_remark(const SourceMotion& motion, const std::string& part) {
  return std::ranges::any_of(motion.remarks, [&](const std::string& remark) {
    return remark.find(part) != std::string::npos;
  });
}

/// Returns the largest distance of the roots of two motions. [m]
double largest_root_distance_m(const Motion& a, const Motion& b) {
  double out = a.poses.size() == b.poses.size() ? 0.0 : HUGE_VAL;
  for (std::size_t f = 0; f < std::min(a.poses.size(), b.poses.size()); ++f) {
    out =
        std::max(out, glm::distance(a.poses[f].root_in_world, b.poses[f].root_in_world));
  }
  return out;
}

TEST(ReadSource, ReadsMotionFilesAlike) {
  const testing::ScratchFolder folder;
  const Motion truth = testing::synthetic_walk(90, 60.0).motion;
  ASSERT_TRUE(write_walk(folder / "a.bvh", MotionFormat::kBvh));
  ASSERT_TRUE(write_walk(folder / "a.npz", MotionFormat::kNpz));
  for (const char* name : {"a.bvh", "a.npz"}) {
    const auto all = motions_of(folder / name);
    ASSERT_EQ(all.size(), 1u) << name;
    EXPECT_NEAR(all[0].motion.rate.hz, 60.0, 1e-3) << name;
    EXPECT_NEAR(all[0].rates.file_hz, 60.0, 1e-3);
    EXPECT_EQ(all[0].rates.basis(), RateBasis::kFile);
    EXPECT_FALSE(all[0].rates.file_is_guessed);
    EXPECT_TRUE(all[0].body.empty());
    EXPECT_LT(figure_of(all[0], "bones_mm"), 0.1) << name;
    EXPECT_TRUE(all[0].problems.empty());
    EXPECT_LT(largest_root_distance_m(all[0].motion, truth), 1e-4) << name;
  }
}

TEST(ReadSource, ReadsVrmaAndMotionObjects) {
  const testing::ScratchFolder folder;
  const Motion truth = testing::synthetic_walk(90, 60.0).motion;
  ASSERT_TRUE(write_walk(folder / "a.vrma", MotionFormat::kVrma));
  EXPECT_EQ(motions_of(folder / "a.vrma").at(0).motion.poses.size(), 90u);
  std::vector<std::vector<JointUncertainty>> sigmas(
      truth.poses.size(),
      std::vector<JointUncertainty>(truth.skeleton.joints.size(),
                                    {0.25, Source::kMeasured, Source::kMeasured}));
  const auto made = library::make_library_motion(truth, sigmas);
  ASSERT_TRUE(made) << made.error().message();
  const auto bytes = recordings::motion_object_bytes(*made);
  ASSERT_TRUE(bytes) << bytes.error().message();
  ASSERT_TRUE(recordings::write_file(folder / "object.npz", *bytes));
  recordings::NpzExtras extras;
  extras.uncertainty = sigmas;
  ASSERT_TRUE(recordings::write_npz(folder / "plain.npz", truth, extras));
  for (const char* name : {"object.npz", "plain.npz"}) {
    const auto all = motions_of(folder / name);
    ASSERT_EQ(all.size(), 1u) << name;
    EXPECT_EQ(all[0].motion.poses.size(), 90u);
    ASSERT_EQ(all[0].uncertainty.size(), 90u) << name;
    EXPECT_EQ(all[0].uncertainty[7][3].sigma_m, 0.25) << name;
    EXPECT_EQ(all[0].uncertainty[7][3].source, Source::kMeasured) << name;
  }
}

/// Returns the figure on contradictions between stated rates; 0: no such figure.
double stated_ratio(const SourceMotion& motion) {
  for (const ClipFigure& figure : motion.figures) {
    if (figure.name == "rate_stated_ratio") return figure.value;
  }
  return 0.0;
}

TEST(ReadSource, KeepsTheRatesOfAllPlaces) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_walk(folder / "a.npz", MotionFormat::kNpz));
  ReadSourceOptions options;
  options.table_rate_hz = 30.0;
  options.table_evidence = "line 3 of data.csv";
  const auto by_table = motions_of(folder / "a.npz", options);
  EXPECT_EQ(by_table.at(0).motion.rate.hz, 30.0);
  EXPECT_EQ(by_table[0].rates.basis(), RateBasis::kTable);
  EXPECT_EQ(stated_ratio(by_table[0]), 2.0);
  EXPECT_TRUE(has_remark(by_table[0],
                         "the index table (line 3 of data.csv) states 30 Hz, but the "
                         "file states 60 Hz"));
  LibrarySource source;
  source.rate_hz = 60.1;
  options.table_rate_hz = 60.0;
  const auto by_option = motions_of(folder / "a.npz", options, source);
  EXPECT_EQ(by_option.at(0).motion.rate.hz, 60.1);
  EXPECT_EQ(by_option[0].rates.file_hz, 60.0);
  EXPECT_EQ(by_option[0].rates.basis(), RateBasis::kOption);
  EXPECT_EQ(stated_ratio(by_option[0]), 1.0) << "they agree within 1 %";
  source.rate_hz = 60.5;
  options.table_rate_hz = std::nullopt;
  const auto rounded = motions_of(folder / "a.npz", options, source);
  EXPECT_EQ(rounded.at(0).motion.rate.hz, 60.5);
  EXPECT_FALSE(has_remark(rounded[0], "states")) << "a difference of 0.8 %";
  source.rate_hz = 60.1;
  // The table describes a recording of another rate, and this file is a copy of it.
  options.table_rate_hz = 30.0;
  options.table_duration_s = 90 / 60.0;
  const auto copy = motions_of(folder / "a.npz", options);
  EXPECT_EQ(copy.at(0).motion.rate.hz, 60.0);
  EXPECT_EQ(copy[0].rates.basis(), RateBasis::kFile);
  EXPECT_EQ(stated_ratio(copy[0]), 1.0);
  source.rate_hz = 1e9;
  EXPECT_NE(refusal_of(folder / "a.npz", {}, source).find("a.npz"), std::string::npos);
}

TEST(ReadSource, NumbersEqualNamesOfBodies) {
  std::vector<SourceMotion> all(6);
  for (std::size_t i = 0; i < 4; ++i) all[i].body = i == 2 ? "Bob (2)" : "Bob";
  number_equal_bodies(all);
  std::vector<std::string> names;
  for (const SourceMotion& motion : all) names.push_back(motion.body);
  EXPECT_EQ(
      names,
      (std::vector<std::string>{"Bob", "Bob (3)", "Bob (2)", "Bob (4)", "", "body (2)"}));
}

/// Repeats the animation of a GLB under two names.
void name_two_animations(const fs::path& path,
                         const std::string& first,
                         const std::string& second) {
  auto bytes = recordings::read_file(path);
  ASSERT_TRUE(bytes) << bytes.error().message();
  constexpr std::size_t kHead = 20;  // Header of the file: 12; of the JSON: 8.
  std::uint32_t size = 0;
  std::memcpy(&size, bytes->data() + 12, 4);
  auto json = nlohmann::json::parse(bytes->substr(kHead, size));
  json["animations"].push_back(json["animations"][0]);
  json["animations"][0]["name"] = first;
  json["animations"][1]["name"] = second;
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  *bytes = bytes->substr(0, kHead) + text + bytes->substr(kHead + size);
  const auto length = static_cast<std::uint32_t>(bytes->size());
  size = static_cast<std::uint32_t>(text.size());
  std::memcpy(bytes->data() + 8, &length, 4);
  std::memcpy(bytes->data() + 12, &size, 4);
  ASSERT_TRUE(recordings::write_file(path, *bytes));
}

TEST(ReadSource, NamesOfAnimationsDiffer) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_walk(folder / "a.vrma", MotionFormat::kVrma));
  // An animation without a name has its number, here the name of the other one.
  name_two_animations(folder / "a.vrma", "animation 1", "");
  const auto all = motions_of(folder / "a.vrma");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].body, "animation 1");
  EXPECT_EQ(all[1].body, "animation 1 (2)");
}

TEST(ReadSource, PutsFeetOnTheFloor) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_walk(folder / "a.npz", MotionFormat::kNpz, 0.2));
  ReadSourceOptions options;
  const auto plain = motions_of(folder / "a.npz", options);
  options.clean = CleanBy::kGround;
  const auto cleaned = motions_of(folder / "a.npz", options);
  ASSERT_EQ(cleaned.size(), 1u);
  const double fell_m = plain.at(0).motion.poses[40].root_in_world.y -
                        cleaned[0].motion.poses[40].root_in_world.y;
  EXPECT_NEAR(fell_m, 0.2, 0.02);
  EXPECT_NEAR(figure_of(cleaned[0], "cleaned_mm"), 200.0, 25.0);
  EXPECT_EQ(figure_of(cleaned[0], "cleaned_samples"),
            90.0 * static_cast<double>(cleaned[0].motion.skeleton.joints.size()));
  EXPECT_TRUE(has_remark(cleaned[0], "clean = \"ground\" moved joints"));
  options.clean = CleanBy::kRepair;
  EXPECT_NE(refusal_of(folder / "a.npz", options).find("works on markers"),
            std::string::npos);
}

TEST(ReadSource, SolvesMarkersOfEachPerson) {
  const testing::ScratchFolder folder;
  const Body person = testing::labelled_person();
  const MarkerTracks one =
      testing::film_markers(person, testing::walking(person), {60, 100.0, 3e-4});
  MarkerTracks both;
  both.rate = one.rate;
  for (const char* name : {"Ann:", "Bob:"}) {
    for (const std::string& label : one.labels) both.labels.push_back(name + label);
  }
  for (std::size_t f = 0; f < one.frames(); ++f) {
    for (const double shift_m : {0.0, 1.5}) {
      for (std::size_t m = 0; m < one.markers(); ++m) {
        auto sample = one.at(f, m);
        if (sample) sample->p_in_world.x += shift_m;
        // A gap of two frames.
        if (m == 3 && (f == 20 || f == 21)) sample.reset();
        both.samples.push_back(sample);
      }
    }
  }
  testing::write_tracks(folder / "two.c3d", both);
  ReadSourceOptions repaired;
  repaired.clean = CleanBy::kRepair;
  const auto all = motions_of(folder / "two.c3d", repaired);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].body, "Ann");
  EXPECT_EQ(all[1].body, "Bob");
  EXPECT_EQ(all[1].subject, "Bob");
  for (const SourceMotion& motion : all) {
    EXPECT_EQ(motion.motion.poses.size(), 60u);
    EXPECT_EQ(motion.uncertainty.size(), 60u);
    EXPECT_LT(figure_of(motion, "residual_mm"), 15.0);
    EXPECT_EQ(figure_of(motion, "filled_samples"), 2.0);
    EXPECT_TRUE(std::ranges::is_sorted(motion.figures, {}, &ClipFigure::name));
  }
  const double apart_m =
      all[1].motion.poses[30].root_in_world.x - all[0].motion.poses[30].root_in_world.x;
  EXPECT_NEAR(apart_m, 1.5, 0.01);
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename(), "two.c3d") << "no other file is written";
  }
}

TEST(ReadSource, RendersRecipes) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_walk(folder / "walk.npz", MotionFormat::kNpz));
  ASSERT_TRUE(recordings::write_file(
      folder / "a.edit.toml",
      "format = 1\n[[source]]\npath = \"walk.npz\"\n"
      "[[op]]\ndo = \"tag@1\"\ntext = \"slow\"\nfrom_frame = 0\nto_frame = 30\n"
      "[[op]]\ndo = \"event@1\"\ntext = \"look\"\nat_frame = 30\n"
      "[[op]]\ndo = \"split@1\"\ninstants = [{at_frame = 40}]\n"));
  LibrarySource source;
  source.rate_hz = 30.0;
  const auto all = motions_of(folder / "a.edit.toml", {}, source);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].body, "a.1");
  EXPECT_EQ(all[1].body, "a.2");
  ASSERT_EQ(all[0].labels.size(), 1u);
  EXPECT_EQ(all[0].labels[0].text, "slow");
  EXPECT_NEAR(all[0].labels[0].end_s, 1.0, 1e-9) << "30 frames at the stated rate";
  ASSERT_EQ(all[0].events.size(), 1u);
  EXPECT_EQ(all[0].events[0].frame, 30);
  EXPECT_EQ(all[0].motion.poses.size() + all[1].motion.poses.size(), 90u);
}

TEST(ReadSource, GivesTheSameRemarksInEveryFolder) {
  const testing::ScratchFolder one;
  const testing::ScratchFolder other;
  for (const testing::ScratchFolder* folder : {&one, &other}) {
    ASSERT_TRUE(write_walk(*folder / "walk.npz", MotionFormat::kNpz));
    ASSERT_TRUE(recordings::write_file(
        *folder / "a.edit.toml",
        "format = 1\n[[source]]\npath = \"walk.npz\"\n[[op]]\ndo = \"plant@1\"\n"));
  }
  const auto a = motions_of(one / "a.edit.toml");
  const auto b = motions_of(other / "a.edit.toml");
  EXPECT_EQ(a.at(0).remarks, b.at(0).remarks);
  for (const std::string& remark : a[0].remarks) {
    EXPECT_EQ(remark.find(one.path().string()), std::string::npos) << remark;
  }
}

TEST(ReadSource, ReadsAllAnimationsOfAGltf) {
  const fs::path path =
      testing::shared_data() / "avatars" / "kaykit" / "Med_MovementBasic.glb";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is absent";
  const auto all = motions_of(path);
  ASSERT_EQ(all.size(), 11u);
  EXPECT_EQ(all[0].body, "Rig_Medium|Jump_Full_Long");
  EXPECT_EQ(all[0].motion.poses.size(), 71u);
  EXPECT_EQ(all[8].body, "Rig_Medium|Walking_A");
  EXPECT_EQ(all[8].motion.poses.size(), 33u);
}

TEST(ReadSource, ReadsRealFilesOfEachKind) {
  const fs::path shared = testing::shared_data();
  struct Sample {
    const char* file;
    std::size_t frames;
    double rate_hz;
    bool is_guessed;
    std::size_t events;
  };
  const std::vector<Sample> samples = {
      {"mocap/bandai/dataset-1_walk_normal_001.bvh", 195, 30.0, false, 0},
      {"mocap/cmu_asfamc/02_01.amc", 343, 120.0, true, 0},
      {"mocap/bmclab/walk.trc", 184, 150.0, false, 0},
      {"mocap/c3d_org_samples/sample_03/gait-pig.c3d", 142, 50.0, false, 9},
      {"avatars/threevrm/test.vrma", 91, 30.0, false, 0},
      {"avatars/khronos/cesium_man.gltf", 49, 24.0, false, 0},
  };
  for (const Sample& sample : samples) {
    const fs::path path = shared / sample.file;
    if (!fs::exists(path)) GTEST_SKIP() << path << " is absent";
    const auto all = motions_of(path);
    ASSERT_EQ(all.size(), 1u) << path;
    EXPECT_EQ(all[0].motion.poses.size(), sample.frames) << path;
    EXPECT_NEAR(all[0].motion.rate.hz, sample.rate_hz, 0.01) << path;
    EXPECT_EQ(all[0].rates.file_is_guessed, sample.is_guessed) << path;
    EXPECT_EQ(all[0].events.size(), sample.events) << path;
  }
}

TEST(ReadSource, StatesFileCauseAndNextStep) {
  const testing::ScratchFolder folder;
  for (const char* name : {"a.bvh",
                           "a.amc",
                           "a.npz",
                           "a.glb",
                           "a.gltf",
                           "a.vrm",
                           "a.vrma",
                           "a.c3d",
                           "a.trc",
                           "a.edit.toml",
                           "s/session.toml"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "nothing of the kind"));
    const bool is_session = std::string(name).starts_with("s/");
    const fs::path path = is_session ? folder / "s" : folder / name;
    const std::string message = refusal_of(path);
    EXPECT_TRUE(message.starts_with((folder / name).string())) << message;
    EXPECT_NE(message.find("Next: "), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace marey::app
