// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "recordings/session/session.h"
#include "tests/recordings/session_text.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

/// A session with devices as cameras and trials that are recorded.
std::string devices() {
  std::string text = with("name = \"right\"\n",
                          "name = \"right\"\ndevice = \"/dev/video0\"\nwidth = 640\n"
                          "height = 480\nfps = 60\nexposure_s = 0.004\nfocus = 0\n"
                          "gain = 12\n");
  const std::string left = "name = \"left\"\n";
  text.insert(text.find(left) + left.size(), "device = \"/dev/video2\"\n");
  for (std::size_t at = text.find("videos = {"); at != std::string::npos;
       at = text.find("videos = {")) {
    text.erase(at, text.find('\n', at) + 1 - at);
  }
  text.erase(text.find("time_offset_s"));
  text.erase(text.find("frames = [0, 7]\n"), std::string("frames = [0, 7]\n").size());
  return text;
}

TEST(SessionDevices, AreReadWithTheirSettings) {
  const Result<Session> session = read(devices());
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_EQ(session->devices.size(), 2U);
  ASSERT_TRUE(session->devices[0]);
  const SessionDevice& right = *session->devices[0];
  EXPECT_EQ(right.path, "/dev/video0");
  EXPECT_EQ(right.width_px, 640);
  EXPECT_EQ(right.height_px, 480);
  EXPECT_EQ(right.rate.hz, 60.0);
  EXPECT_EQ(right.exposure_s, 0.004);
  EXPECT_EQ(right.focus, 0);
  EXPECT_EQ(right.gain, 12);
}

TEST(SessionDevices, HaveDefaults) {
  const Result<Session> session = read(devices());
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_TRUE(session->devices[1]);
  const SessionDevice& left = *session->devices[1];
  EXPECT_EQ(left.width_px, 1280);
  EXPECT_EQ(left.height_px, 720);
  EXPECT_EQ(left.rate.hz, 30.0);
  EXPECT_FALSE(left.exposure_s);
  EXPECT_FALSE(left.focus);
  EXPECT_FALSE(left.gain);
}

TEST(SessionDevices, NeedNoVideosAndNameWhereTheyWillBe) {
  const Result<Session> session = read(devices());
  ASSERT_TRUE(session) << session.error().message();
  const Trial* walk = session->find("walk");
  ASSERT_NE(walk, nullptr);
  EXPECT_TRUE(walk->is_recorded);
  ASSERT_EQ(walk->videos.size(), 2U);
  // Next to session.toml, independent of `media`.
  EXPECT_EQ(walk->videos[1].path, session->file.parent_path() / "walk" / "left.mkv");
}

TEST(SessionDevices, LeaveTrialsWithVideosAlone) {
  const Result<Session> session =
      read(with("name = \"right\"\n", "name = \"right\"\ndevice = \"/dev/video0\"\n"));
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_FALSE(session->find("walk")->is_recorded);
}

TEST(SessionDevices, ThatAreSharedAreRefused) {
  EXPECT_EQ(mistake(testing::replace_first(devices(), "/dev/video2", "/dev/video0")),
            "session.toml:37: two cameras have the device \"/dev/video0\". Next: name "
            "each camera's own: marey doctor lists them.");
}

TEST(SessionDevices, SettingsWithoutADeviceAreRefused) {
  EXPECT_EQ(mistake(with("name = \"right\"\n", "name = \"right\"\ngain = 3\n")),
            "session.toml:28: \"gain\" is for a camera to record from, and none is "
            "named. Next: add device = \"/dev/video0\", or remove the key.");
}

TEST(SessionDevices, NeedWidthAndHeightTogether) {
  EXPECT_TRUE(mistake(testing::replace_first(devices(), "height = 480\n", ""))
                  .starts_with("session.toml:26: the key \"height\" is missing"));
}

TEST(SessionDevices, OutOfAllReasonAreRefused) {
  EXPECT_NE(
      mistake(testing::replace_first(devices(), "exposure_s = 0.004", "exposure_s = 4")),
      "");
  EXPECT_NE(mistake(testing::replace_first(devices(), "fps = 60", "fps = 0")), "");
  EXPECT_NE(mistake(testing::replace_first(devices(), "width = 640", "width = 0")), "");
  EXPECT_NE(mistake(testing::replace_first(devices(), "/dev/video2", "")), "");
}

TEST(SessionDevices, WithoutAnyDeviceVideosAreNeeded) {
  EXPECT_NE(mistake(with("videos = { left = \"walk/left.mp4\", right = "
                         "\"walk/right.mp4\" }\ntime_offset_s = { left = 0.0073 }\n",
                         ""))
                .find("trial \"walk\" has no video"),
            std::string::npos);
}

TEST(SessionDevices, ReportATrialThatIsNotRecordedYet) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", devices()));
  const Result<Session> session = read_session(folder.path());
  ASSERT_TRUE(session) << session.error().message();
  const Status files = check_files(*session);
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message().find(
                "trial \"calib\" is not recorded yet. Next: marey record SESSION"),
            std::string::npos)
      << files.error().message();
}

}  // namespace
}  // namespace marey::recordings
