// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/clip_motions.h"

#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/clip_record_file.h"
#include "tests/app/library/export/export_scene.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns the error of reading a clip; an empty one if there is none.
Error error_of(const ClipRecord& clip, const fs::path& library) {
  ClipMotions motions(library, OuterLinks::kRefuse);
  const auto motion = motions.read(clip);
  return motion ? Error{} : motion.error();
}

bool says(const Error& error, const std::string& words) {
  return error.message().find(words) != std::string::npos;
}

TEST(ClipMotions, ReadsTheFramesOfAClip) {
  testing::ExportScene scene;
  ClipMotions motions(scene.library(), OuterLinks::kRefuse);
  for (const ClipRecord& clip : scene.records()) {
    const auto motion = motions.read(clip);
    ASSERT_TRUE(motion) << motion.error().message();
    EXPECT_EQ(motion->motion.first_frame, clip.first_frame);
    EXPECT_EQ(static_cast<int>(motion->motion.poses.size()), clip.frame_count());
  }
}

TEST(ClipMotions, RefusesKeysThatAreOtherFiles) {
  testing::ExportScene scene;
  ClipRecord clip = scene.records().front();
  for (const std::string& key : {std::string(),
                                 std::string("../../../etc"),
                                 clip.object_key + "/../x",
                                 std::string(64, 'A'),
                                 std::string(64, '/')}) {
    clip.object_key = key;
    const Error error = error_of(clip, scene.library());
    EXPECT_TRUE(says(error, "not the name of a motion object")) << error.message();
  }
}

TEST(ClipMotions, RefusesFramesThatTheObjectDoesNotHave) {
  testing::ExportScene scene;
  const ClipRecord clip = scene.records().front();
  constexpr int kMin = std::numeric_limits<int>::min();
  constexpr int kMax = std::numeric_limits<int>::max();
  for (const FrameRange frames : {FrameRange{99, 120},
                                  FrameRange{110, 220},
                                  FrameRange{120, 119},
                                  FrameRange{kMin, kMax},
                                  FrameRange{kMin, kMin},
                                  FrameRange{kMax, kMax}}) {
    ClipRecord other = clip;
    other.first_frame = frames.first;
    other.last_frame = frames.last;
    EXPECT_TRUE(says(error_of(other, scene.library()), "does not have the frames"))
        << frames.first;
  }
}

TEST(ClipMotions, NamesTheStepsThatMakeAnObjectAgain) {
  testing::ExportScene scene;
  const ClipRecord& clip = scene.records().front();
  const fs::path file =
      scene.library() / recordings::object_path(clip.object_key, ".npz");
  ASSERT_TRUE(recordings::write_file(file, "no archive"));
  const std::string next =
      "delete the file if it exists, then build the library again: "
      "marey library build " +
      scene.library().string();
  const Error damaged = error_of(clip, scene.library());
  EXPECT_TRUE(says(damaged, file.string())) << damaged.message();
  EXPECT_TRUE(says(damaged, next)) << damaged.message();
  fs::remove(file);
  const Error missing = error_of(clip, scene.library());
  EXPECT_TRUE(says(missing, "missing")) << missing.message();
  EXPECT_TRUE(says(missing, next)) << missing.message();
}

TEST(ClipMotions, FollowsOuterLinksOnlyIfAllowed) {
  testing::ExportScene scene;
  const testing::ScratchFolder elsewhere;
  fs::rename(scene.library() / "objects", elsewhere / "objects");
  fs::create_directory_symlink(elsewhere / "objects", scene.library() / "objects");
  const ClipRecord& clip = scene.records().front();
  EXPECT_TRUE(says(error_of(clip, scene.library()), "leads out"));
  EXPECT_TRUE(ClipMotions(scene.library(), OuterLinks::kFollow).read(clip));
}

}  // namespace
}  // namespace marey::app
