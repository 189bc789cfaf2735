// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/session_copy.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/session_text.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

/// The walk is recorded; the other trials have videos.
std::string mixed(const std::string& media) {
  std::string text =
      with("name = \"right\"\n", "name = \"right\"\ndevice = \"/dev/video0\"\n");
  const std::size_t videos = text.rfind("videos = {");
  text.erase(videos);
  text.replace(text.find("media = \"videos\"\n"), 17, media);
  return text;
}

Result<Session> session_in(const fs::path& folder, const std::string& text) {
  EXPECT_TRUE(write_file(folder / "session.toml", text));
  return read_session(folder);
}

TEST(CopySession, LeavesVideosWhereTheyAre) {
  for (const std::string& media : {std::string("media = \"videos\"\n"), std::string()}) {
    const ScratchFolder folder;
    const auto session = session_in(folder / "s", mixed(media));
    ASSERT_TRUE(session) << session.error().message();
    const Trial& walk = *session->find("walk");
    ASSERT_TRUE(copy_session(*session, folder / "take", walk));
    const auto copy = read_session(folder / "take");
    ASSERT_TRUE(copy) << copy.error().message();
    EXPECT_EQ(copy->find("calib")->videos[0].path,
              session->find("calib")->videos[0].path);
    EXPECT_EQ(copy->find("walk")->videos[0].path, folder / "take" / "walk" / "right.mkv");
    // A second trial into the same folder.
    EXPECT_TRUE(copy_session(*session, folder / "take", walk));
  }
}

TEST(CopySession, NamesFoldersThatHaveAnyName) {
  for (const char* name : {"a \"b\"", "back\\slash", "line\nbreak", "\xC3\xA4 #1"}) {
    const ScratchFolder folder;
    const auto session = session_in(folder / name, mixed("media = \"videos\"\n"));
    ASSERT_TRUE(session) << session.error().message();
    const Status copied = copy_session(*session, folder / "take", *session->find("walk"));
    ASSERT_TRUE(copied) << copied.error().message();
    const auto copy = read_session(folder / "take");
    ASSERT_TRUE(copy) << copy.error().message();
    EXPECT_EQ(copy->find("calib")->videos[0].path,
              session->find("calib")->videos[0].path);
  }
}

TEST(CopySession, LeavesLensesWhereTheyAre) {
  const ScratchFolder folder;
  const auto session = session_in(
      folder / "s",
      mixed("media = \"videos\"\n") +
          "[calibration]\nlens = \"rational\"\nlenses = \"old.toml\"  # ours\n");
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_TRUE(copy_session(*session, folder / "take", *session->find("walk")));
  const auto copy = read_session(folder / "take");
  ASSERT_TRUE(copy) << copy.error().message();
  EXPECT_EQ(copy->calibration.lenses, folder / "s" / "old.toml");
  EXPECT_EQ(copy->calibration.lens, LensModel::kRational);
}

// The file has no line end at its end.
TEST(CopySession, ReplacesAMediaThatIsTheLastLine) {
  const ScratchFolder folder;
  const std::string text = R"(format = 1
name = "dev"
subject = { name = "S16", stature_m = 1.734 }
tags = { tag = [{ id = 41, segment = "hips", size_m = 0.09 }] }
camera = [{ name = "right", device = "/dev/video0" }, { name = "left" }]
board = { type = "aprilgrid", rows = 6, columns = 5, tag_size_m = 0.1, gap_m = 0.03, first_id = 0 }
trial = [
  { name = "calib", kind = "calibration", videos = { left = "l.mp4", right = "r.mp4" } },
  { name = "floor", kind = "floor", frames = [0, 7], videos = { left = "l.mp4", right = "r.mp4" } },
  { name = "walk", kind = "motion" },
]
media = "videos")";
  const auto session = session_in(folder / "s", text);
  ASSERT_TRUE(session) << session.error().message();
  const Status copied = copy_session(*session, folder / "take", *session->find("walk"));
  ASSERT_TRUE(copied) << copied.error().message();
  const auto copy = read_session(folder / "take");
  ASSERT_TRUE(copy) << copy.error().message();
  EXPECT_EQ(copy->find("calib")->videos[0].path, session->find("calib")->videos[0].path);
}

// TOML is UTF-8, but names of folders may not be.
TEST(CopySession, DeclinesAFolderThatCannotBeNamed) {
  const ScratchFolder folder;
  const auto session = session_in(folder / "\xE4", mixed("media = \"videos\"\n"));
  ASSERT_TRUE(session) << session.error().message();
  const Status copied = copy_session(*session, folder / "take", *session->find("walk"));
  ASSERT_FALSE(copied);
  EXPECT_EQ(copied.error().cause, "its videos cannot be named from another folder");
  EXPECT_FALSE(fs::exists(folder / "take" / "session.toml"));
}

TEST(CopySession, DoesNotTouchAnotherSession) {
  const ScratchFolder folder;
  const auto session = session_in(folder / "s", mixed("media = \"videos\"\n"));
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_TRUE(write_file(folder / "take" / "session.toml", kSession));
  const Status copied = copy_session(*session, folder / "take", *session->find("walk"));
  ASSERT_FALSE(copied);
  EXPECT_EQ(copied.error().cause,
            "it has no trial \"walk\" of the kind \"motion\" to record");
}

}  // namespace
}  // namespace marey::recordings
