// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/recordings/session_text.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

TEST(Session, ReadsTheSubject) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->name, "dev");
  EXPECT_EQ(session->subject.name, "S16");
  EXPECT_EQ(session->subject.stature_m, 1.734);
  EXPECT_EQ(session->subject.mass_kg, 70.0);
}

TEST(Session, ReadsTags) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  ASSERT_EQ(session->tags.size(), 2U);
  ASSERT_EQ(session->families.size(), 1U);
  EXPECT_EQ(session->families[0].name, "tag36h11");
  EXPECT_EQ(session->family_of(TagId{73}), "tag36h11");
  EXPECT_EQ(session->tags[1].id, TagId{73});
  EXPECT_EQ(session->tags[1].segment, HumanBone::kHead);
  EXPECT_EQ(session->tags[1].size_m, 0.075);
}

TEST(Session, ReadsTheBoard) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  const auto& board = std::get<AprilGrid>(session->target);
  EXPECT_EQ(board.rows, 6);
  EXPECT_EQ(board.columns, 5);
  EXPECT_EQ(board.tag_size_m, 0.1);
  EXPECT_EQ(board.gap_m, 0.03);
  EXPECT_EQ(board.thickness_m, 0.005);
}

TEST(Session, KeepsCamerasInTheOrderOfTheFile) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  EXPECT_EQ(session->cameras, (std::vector<std::string>{"right", "left"}));
}

TEST(Session, ReadsTrialsWithVideosInCameraOrder) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  const Trial* walk = session->find("walk");
  ASSERT_NE(walk, nullptr);
  EXPECT_EQ(walk->kind, TrialKind::kMotion);
  EXPECT_FALSE(walk->rate);
  ASSERT_EQ(walk->videos.size(), 2U);
  EXPECT_EQ(walk->videos[1].camera, CameraId{1});
  EXPECT_EQ(walk->videos[1].path.filename(), "left.mp4");
  EXPECT_EQ(walk->videos[1].offset, from_seconds(0.0073));
  EXPECT_FALSE(walk->videos[0].offset);
}

TEST(Session, ReadsRateAndFramesWhereGiven) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  EXPECT_EQ(session->find(TrialKind::kCalibration)->rate->hz, 10.0);
  const Trial* floor = session->find(TrialKind::kFloor);
  ASSERT_TRUE(floor->frames);
  EXPECT_EQ(floor->frames->first, 0);
  EXPECT_EQ(floor->frames->last, 7);
}

TEST(Session, AcceptsTheFolderAndTheFileAlike) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", kSession));
  const Result<Session> by_folder = read_session(folder.path());
  const Result<Session> by_file = read_session(folder / "session.toml");
  ASSERT_TRUE(by_folder);
  ASSERT_TRUE(by_file);
  EXPECT_EQ(by_folder->file, by_file->file);
}

TEST(Session, VideosAreRelativeToMediaWhichIsRelativeToTheSession) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", kSession));
  const Result<Session> session = read_session(folder.path());
  ASSERT_TRUE(session);
  EXPECT_EQ(session->trials[0].videos[0].path, folder / "videos/calib/right.mp4");
}

TEST(Session, WithoutMediaVideosAreRelativeToTheSession) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", with("media = \"videos\"\n", "")));
  const Result<Session> session = read_session(folder.path());
  ASSERT_TRUE(session);
  EXPECT_EQ(session->trials[0].videos[0].path, folder / "calib/right.mp4");
}

TEST(Session, TheCallersMediaTakesThePlaceOfTheSessions) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", kSession));
  const Result<Session> session = read_session(folder.path(), {.media = "/elsewhere"});
  ASSERT_TRUE(session);
  EXPECT_EQ(session->trials[0].videos[0].path, "/elsewhere/calib/right.mp4");
}

TEST(CheckFiles, NamesTheFirstVideoThatIsNotThereAndItsLine) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", kSession));
  ASSERT_TRUE(write_file(folder / "videos/calib/left.mp4", ""));
  ASSERT_TRUE(write_file(folder / "videos/calib/right.mp4", ""));
  const Result<Session> session = read_session(folder.path());
  ASSERT_TRUE(session);
  const Status status = check_files(*session);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().where, (folder / "session.toml").string() + ":43");
  EXPECT_EQ(
      status.error().cause,
      "trial walk: " + (folder / "videos/walk/right.mp4").string() + " does not exist");
}

TEST(CheckFiles, IsContentWhenAllVideosAreThere) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", kSession));
  for (const char* name : {"calib/left", "calib/right", "walk/left", "walk/right"}) {
    ASSERT_TRUE(write_file(folder / ("videos/" + std::string(name) + ".mp4"), ""));
  }
  const Result<Session> session = read_session(folder.path());
  ASSERT_TRUE(session);
  EXPECT_TRUE(check_files(*session));
}

TEST(Session, TheExampleOfTheFormatsPageIsComplete) {
  const std::string example = marey::testing::formats_example("session");
  const Result<Session> session = read(example);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->trials.size(), 3U);
}

const fs::path kSample = marey::testing::source_dir() / "recordings/samples/blender-dev";

TEST(SampleSession, IsRead) {
  const Result<Session> session = read_session(kSample);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->tags.size(), 29U);
  EXPECT_EQ(session->cameras.size(), 4U);
  EXPECT_EQ(session->trials.size(), 7U);
}

TEST(SampleSession, HasAllItsVideos) {
  const fs::path data = marey::testing::shared_data() / "blender/dev";
  if (!fs::exists(data)) GTEST_SKIP() << "the recording blender/dev is missing";
  const Result<Session> session = read_session(kSample, {.media = data});
  ASSERT_TRUE(session) << session.error().message();
  const Status status = check_files(*session);
  EXPECT_TRUE(status) << status.error().message();
}

}  // namespace
}  // namespace marey::recordings
