// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_library.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/motion/bvh.h"
#include "tests/app/library/export/export_scene.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::ExportScene;

/// Reads an export with NumPy and Python's modules.
void expect_python_reads(const ExportScene& scene,
                         const ExportOptions& options,
                         bool is_own) {
  std::vector<std::string> arguments{
      (testing::source_dir() / "tests/tools/check_library_export.py").string(),
      scene.library().string(),
      options.out.string(),
      std::string(name(options.format))};
  if (is_own) arguments.emplace_back("--own");
  const auto run = testing::run_program("/usr/bin/python3", arguments);
  if (run.exit_code == 77) GTEST_SKIP() << run.out;
  EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
}

std::string text_of(const fs::path& path) {
  const auto text = recordings::read_file(path);
  return text ? *text : text.error().message();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class EachExportFormat : public ::testing::TestWithParam<ExportFormat> {};

TEST_P(EachExportFormat, IsReadByOthersAndHasTheLibrarysJoints) {
  const ExportScene scene;
  const ExportOptions options = scene.options(GetParam(), "own");
  std::vector<int> numbers;
  const bool needs_all_bones = GetParam() == ExportFormat::kAmass ||
                               GetParam() == ExportFormat::kJoints22 ||
                               GetParam() == ExportFormat::kPack;
  if (needs_all_bones) numbers = {0, 1, 2};
  const auto report = scene.run(options, numbers);
  ASSERT_TRUE(report) << report.error().message();
  EXPECT_TRUE(report->left_out.empty());
  expect_python_reads(scene, options, true);
}

TEST_P(EachExportFormat, OnOneSkeletonAtOneRateMirrored) {
  const ExportScene scene;
  ExportOptions options = scene.options(GetParam(), "one");
  options.skeleton = "lafan22";
  options.rate_hz = 20.0;
  options.adds_mirrored = true;
  options.starts_at_origin = true;
  const auto report = scene.run(options);
  ASSERT_TRUE(report) << report.error().message();
  ASSERT_EQ(report->clips.size(), 8u);
  expect_python_reads(scene, options, false);
}

TEST_P(EachExportFormat, HasTheSameBytesTwice) {
  const ExportScene scene;
  ExportOptions options = scene.options(GetParam(), "a");
  options.skeleton = "smpl22";
  options.adds_mirrored = true;
  ASSERT_TRUE(scene.run(options));
  const std::string first = testing::hash_folder(options.out);
  options.out = scene.out("b");
  ASSERT_TRUE(scene.run(options));
  EXPECT_EQ(testing::hash_folder(options.out), first);
  // Replaced, from another library of the same content.
  const ExportScene other;
  ExportOptions again = other.options(GetParam(), "a");
  again.skeleton = "smpl22";
  again.adds_mirrored = true;
  ASSERT_TRUE(other.run(again));
  EXPECT_EQ(testing::hash_folder(again.out), first);
}

TEST_P(EachExportFormat, IsRefusedByLicencesBeforeAnythingIsWritten) {
  ExportScene scene;
  scene.records()[0].provenance.licence = "CC-BY-NC-4.0";
  scene.records()[1].provenance.licence = "";
  scene.records()[2].provenance.licence = "MIT AND LICENCE.txt";
  ExportOptions options = scene.options(GetParam(), "refused");
  const auto refused = scene.run(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadInput);
  EXPECT_EQ(refused.error().message(),
            scene.library().string() +
                ": licences do not permit this export of 3 clips: CC-BY-NC-4.0 (1 clip) "
                "forbids commercial use, MIT AND LICENCE.txt (1 clip) has terms that "
                "only a person can judge, unknown (1 clip) states no permission. Next: "
                "if your use is permitted, add --allow-licence CC-BY-NC-4.0,LICENCE.txt "
                "and --licence-unknown; else leave these clips out with --query.");
  EXPECT_TRUE(fs::is_empty(options.out.parent_path()));
  options.allowance = {{"CC-BY-NC-4.0", "LICENCE.txt"}, true};
  if (GetParam() == ExportFormat::kPack) options.skeleton = "marey";
  EXPECT_TRUE(scene.run(options));
}

INSTANTIATE_TEST_SUITE_P(ExportLibrary,
                         EachExportFormat,
                         ::testing::ValuesIn(export_formats().begin(),
                                             export_formats().end()),
                         [](const auto& format) {
                           return std::string(name(format.param));
                         });

TEST(ExportLibrary, WritesGltfThatTheValidatorAccepts) {
  const ExportScene scene;
  const fs::path script = testing::source_dir() / "tests/tools/validate_gltf.mjs";
  for (const ExportFormat format : {ExportFormat::kGlb, ExportFormat::kVrma}) {
    ExportOptions options = scene.options(format, std::string(name(format)));
    options.adds_mirrored = true;
    ASSERT_TRUE(scene.run(options));
    std::vector<std::string> arguments{script.string()};
    for (const auto& entry : fs::directory_iterator(options.out)) {
      const fs::path file = entry.path();
      if (file.extension() == "." + std::string(name(format))) {
        arguments.push_back(file.string());
      }
    }
    EXPECT_EQ(arguments.size(), 9u);
    arguments.insert(arguments.begin(), "node");
    const auto run = testing::run_program("/usr/bin/env", arguments);
    if (run.exit_code == 77 || run.exit_code == 127) {
      GTEST_SKIP() << "node or gltf-validator is missing; run `npm ci` in tests/tools";
    }
    EXPECT_EQ(run.exit_code, 0) << run.out;
  }
}

TEST(ExportLibrary, RefusesChangedCopiesOnlyWhereALicenceForbidsThem) {
  ExportScene scene;
  for (ClipRecord& clip : scene.records()) clip.provenance.licence = "CC-BY-ND-4.0";
  int number = 0;
  const auto is_permitted = [&](auto change) {
    ExportOptions options = scene.options(ExportFormat::kNpz, std::to_string(number++));
    change(options);
    return scene.run(options).has_value();
  };
  EXPECT_TRUE(is_permitted([](ExportOptions&) {}));
  EXPECT_TRUE(is_permitted([](ExportOptions& o) { o.format = ExportFormat::kBvh; }));
  EXPECT_TRUE(is_permitted([](ExportOptions& o) { o.format = ExportFormat::kTable; }));
  EXPECT_FALSE(is_permitted([](ExportOptions& o) { o.skeleton = "marey"; }));
  EXPECT_FALSE(is_permitted([](ExportOptions& o) { o.rate_hz = 30.0; }));
  EXPECT_FALSE(is_permitted([](ExportOptions& o) { o.adds_mirrored = true; }));
  EXPECT_FALSE(is_permitted([](ExportOptions& o) { o.starts_at_origin = true; }));
  EXPECT_FALSE(
      is_permitted([](ExportOptions& o) { o.format = ExportFormat::kMatching; }));
}

TEST(ExportLibrary, StatesLicencesWithAttributionAndChoice) {
  ExportScene scene;
  scene.records()[2].provenance.licence = "CC-BY-NC-4.0 OR MIT";
  scene.records()[3].provenance.licence = "licences/own.txt";
  ASSERT_TRUE(recordings::write_file(scene.library() / "licences/own.txt", "Be kind.\n"));
  ExportOptions options = scene.options(ExportFormat::kTable, "t");
  options.allowance.licences = {"licences/own.txt"};
  const auto report = scene.run(options);
  ASSERT_TRUE(report) << report.error().message();
  const std::string text = text_of(options.out / "LICENCES.md");
  EXPECT_TRUE(contains(text, "## CC-BY-4.0\n\nName the origin.")) << text;
  EXPECT_TRUE(contains(text, "- Anna's, lab, 2024\n")) << text;
  EXPECT_TRUE(contains(text, "The most permissive alternative was chosen: MIT.\n"))
      << text;
  EXPECT_TRUE(contains(text, "Be kind.\n")) << text;
  for (const ClipRecord& clip : report->clips) {
    EXPECT_TRUE(contains(text, "\n" + clip.clip_id + "\n"));
  }
}

TEST(ExportLibrary, DescribesContentsAndOmissions) {
  const ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kJoints22, "j");
  options.query = "quality=warn | x";
  const auto report = scene.run(options, {0, 2, 3});
  ASSERT_TRUE(report) << report.error().message();
  ASSERT_EQ(report->left_out.size(), 1u);
  EXPECT_EQ(report->left_out[0].reason, "the body has no bone \"upperChest\"");
  const std::string text = text_of(options.out / "DATASHEET.md");
  for (const char* part : {"2 clips, 150 frames, 0.001 hours.",
                           "Version of the library: 10, SHA-256 ffff",
                           "| query | quality=warn \\| x |",
                           "| anna | 1 | 0.000 |",
                           "## Settings",
                           "| turn left | 1 |",
                           "1 of 4 clips of the library were not selected",
                           "| stiff | the body has no bone \"upperChest\" |"}) {
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
  }
}

TEST(ExportLibrary, RefusesAnExportWithoutClips) {
  const ExportScene scene;
  const auto none = scene.run(scene.options(ExportFormat::kAmass, "a"), {3});
  ASSERT_FALSE(none);
  EXPECT_TRUE(contains(none.error().message(),
                       "none of the 1 selected clips can be exported; the first, stiff: "
                       "the body has no bone \"upperChest\""))
      << none.error().message();
  EXPECT_TRUE(fs::is_empty(scene.out("")));
  const auto empty = export_library(scene.options(ExportFormat::kNpz, "b"), {}, {});
  ASSERT_FALSE(empty);
  EXPECT_TRUE(contains(empty.error().message(), "the library has no clips"));
}

TEST(ExportLibrary, MirrorsMotionsLabelsEventsAndContacts) {
  const ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kBvh, "m");
  options.adds_mirrored = true;
  const auto report = scene.run(options, {0});
  ASSERT_TRUE(report) << report.error().message();
  ASSERT_EQ(report->clips.size(), 2u);
  const ClipRecord& mirrored = report->clips[1];
  EXPECT_EQ(mirrored.clip_id, report->clips[0].clip_id + "_mirror");
  EXPECT_EQ(mirrored.mirror_of, report->clips[0].clip_id);
  EXPECT_EQ(mirrored.split, report->clips[0].split);
  ASSERT_EQ(mirrored.labels.size(), 1u);
  EXPECT_EQ(mirrored.labels[0].text, "turn right");
  EXPECT_EQ(mirrored.events[0].name, "right.strike");
  EXPECT_EQ(mirrored.figures[0].joint, "rightFoot");
  ASSERT_EQ(report->unknown_sides.size(), 1u);
  EXPECT_EQ(report->unknown_sides[0].label, "a \"leftish\", step");
  EXPECT_TRUE(
      contains(text_of(options.out / "DATASHEET.md"), "| a \"leftish\", step | 1 |"));
  const auto plain = recordings::read_bvh(options.out / (mirrored.mirror_of + ".bvh"));
  const auto other = recordings::read_bvh(options.out / (mirrored.clip_id + ".bvh"));
  ASSERT_TRUE(plain && other);
  const Skeleton& skeleton = plain->motion.skeleton;
  for (std::size_t f = 0; f < plain->motion.poses.size(); f += 10) {
    const auto a = world_from_joints(skeleton, plain->motion.poses[f]);
    const auto b = world_from_joints(skeleton, other->motion.poses[f]);
    for (const HumanBone bone : human_bones()) {
      const auto at = a[index(*skeleton.find(bone))].translation;
      const auto mirror = b[index(*skeleton.find(marey::mirrored(bone)))].translation;
      EXPECT_NEAR(at.x, -mirror.x, 1e-4);
      EXPECT_NEAR(at.y, mirror.y, 1e-4);
      EXPECT_NEAR(at.z, mirror.z, 1e-4);
    }
  }
}

TEST(ExportLibrary, ConvertsTimesToTheNewRate) {
  const ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kNpz, "r");
  options.rate_hz = 30.0;
  const auto report = scene.run(options, {0});
  ASSERT_TRUE(report);
  const ClipRecord& clip = report->clips[0];
  EXPECT_EQ(clip.first_frame, 55) << "frame 110 at 60 Hz";
  EXPECT_EQ(clip.last_frame, 84);
  EXPECT_EQ(clip.rate_hz, 30.0);
  EXPECT_EQ(clip.events[0].frame, 3);
  EXPECT_EQ(clip.events[1].frame, 15);
  EXPECT_DOUBLE_EQ(clip.labels[1].start_s, 0.25);
}

TEST(ExportLibrary, RefusesBodiesOfOtherJointsInAPack) {
  ExportScene scene;
  const auto report = scene.run(scene.options(ExportFormat::kPack, "p"));
  ASSERT_FALSE(report);
  EXPECT_TRUE(contains(report.error().message(), "export with --skeleton marey"))
      << report.error().message();
  EXPECT_TRUE(fs::is_empty(scene.out("")));
}

TEST(ExportLibrary, ReportsAMissingObject) {
  const ExportScene scene;
  fs::remove_all(scene.library() / "objects");
  const auto report = scene.run(scene.options(ExportFormat::kNpz, "p"));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kBadInput);
  EXPECT_EQ(report.error().next,
            "delete the file if it exists, then build the library again: marey library "
            "build " +
                scene.library().string());
  EXPECT_TRUE(fs::is_empty(scene.out("")));
}

TEST(ExportLibrary, KeepsSplitsWhenTheQueryChanges) {
  const ExportScene scene;
  const auto all = scene.run(scene.options(ExportFormat::kTable, "a"));
  const auto some = scene.run(scene.options(ExportFormat::kTable, "b"), {1, 3});
  ASSERT_TRUE(all && some);
  EXPECT_EQ(all->clips[0].split, all->clips[1].split) << "one subject";
  EXPECT_EQ(all->clips[1].split, some->clips[0].split);
  EXPECT_EQ(all->clips[3].split, some->clips[1].split);
}

}  // namespace
}  // namespace marey::app
