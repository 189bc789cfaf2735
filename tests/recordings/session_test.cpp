// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "recordings/atomic_file.h"
#include "tests/recordings/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSession = R"(format = 1
name = "dev"
media = "videos"
[subject]
name = "S16"
stature_m = 1.734
mass_kg = 70
[tags]
family = "tag36h11"
[[tags.tag]]
id = 41
segment = "hips"
size_m = 0.09
[[tags.tag]]
id = 73
segment = "head"
size_m = 0.075
[board]
type = "aprilgrid"
rows = 6
columns = 5
tag_size_m = 0.1
gap_m = 0.03
first_id = 0
thickness_m = 0.005
[[camera]]
name = "right"
[[camera]]
name = "left"
[[trial]]
name = "calib"
kind = "calibration"
fps = 10
videos = { left = "calib/left.mp4", right = "calib/right.mp4" }
[[trial]]
name = "floor"
kind = "floor"
frames = [0, 7]
videos = { left = "calib/left.mp4", right = "calib/right.mp4" }
[[trial]]
name = "walk"
kind = "motion"
videos = { left = "walk/left.mp4", right = "walk/right.mp4" }
time_offset_s = { left = 0.0073 }
)";

/// kSession with every `from` replaced; the test fails when there is none.
std::string with(std::string_view from, std::string_view to) {
  std::string text(kSession);
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

Result<Session> read(std::string_view text) {
  const ScratchFolder folder;
  EXPECT_TRUE(write_file(folder / "session.toml", text));
  return read_session(folder.path());
}

/// The error's message after the folder: "session.toml:6: ...". Empty when there is none.
std::string mistake(std::string_view text) {
  const Result<Session> session = read(text);
  if (session) return "";
  const std::string message = session.error().message();
  return message.substr(message.find("session.toml"));
}

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
  EXPECT_EQ(session->tag_family, "tag36h11");
  EXPECT_EQ(session->tags[1].id, TagId{73});
  EXPECT_EQ(session->tags[1].segment, HumanBone::kHead);
  EXPECT_EQ(session->tags[1].size_m, 0.075);
}

TEST(Session, ReadsTheBoard) {
  const Result<Session> session = read(kSession);
  ASSERT_TRUE(session);
  EXPECT_EQ(session->board.rows, 6);
  EXPECT_EQ(session->board.columns, 5);
  EXPECT_EQ(session->board.tag_size_m, 0.1);
  EXPECT_EQ(session->board.gap_m, 0.03);
  EXPECT_EQ(session->board.thickness_m, 0.005);
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

TEST(Session, NamesTheLineThatIsNotToml) {
  const std::string message = mistake(with("rows = 6", "rows = = 6"));
  EXPECT_TRUE(message.starts_with("session.toml:20: not valid TOML: ")) << message;
}

TEST(Session, NamesAMissingKey) {
  EXPECT_EQ(
      mistake(with("stature_m = 1.734\n", "")),
      "session.toml:4: the key \"stature_m\" is missing in [subject]. Next: add it; "
      "docs/formats.md says what it means.");
}

TEST(Session, SuggestsTheNearestKeyForAnUnknownOne) {
  EXPECT_EQ(
      mistake(with("stature_m", "statur_m")),
      "session.toml:6: unknown key \"statur_m\" in [subject]. Next: perhaps you mean "
      "\"stature_m\".");
}

TEST(Session, ListsTheKeysWhenNoneIsNear) {
  EXPECT_EQ(mistake(with("mass_kg", "shoe")),
            "session.toml:7: unknown key \"shoe\" in [subject]. Next: choose one of "
            "\"name\", \"stature_m\", \"mass_kg\".");
}

TEST(Session, FindsUnknownKeysInEveryTable) {
  EXPECT_TRUE(mistake(with("media", "mediums")).starts_with("session.toml:3: unknown"));
  EXPECT_TRUE(mistake(with("family", "famly")).starts_with("session.toml:9: unknown"));
  EXPECT_TRUE(
      mistake(with("id = 73", "nr = 73")).starts_with("session.toml:15: unknown"));
  EXPECT_TRUE(mistake(with("rows", "row")).starts_with("session.toml:20: unknown"));
  EXPECT_TRUE(mistake(with("name = \"left\"", "label = \"left\""))
                  .starts_with("session.toml:29: unknown"));
  EXPECT_TRUE(mistake(with("fps", "hz")).starts_with("session.toml:33: unknown"));
}

TEST(Session, NamesAWrongType) {
  EXPECT_EQ(mistake(with("fps = 10", "fps = \"10\"")),
            "session.toml:33: \"fps\" must be a number. Next: write it as "
            "docs/formats.md shows.");
}

TEST(Session, RefusesANumberThatIsNotFinite) {
  EXPECT_TRUE(mistake(with("stature_m = 1.734", "stature_m = nan"))
                  .starts_with("session.toml:6: \"stature_m\" must be a number"));
}

TEST(Session, RefusesHalfATag) {
  EXPECT_TRUE(mistake(with("id = 41", "id = 41.5"))
                  .starts_with("session.toml:11: \"id\" must be a whole number"));
}

TEST(Session, CatchesMillimetresGivenAsMetres) {
  EXPECT_EQ(mistake(with("size_m = 0.09", "size_m = 90")),
            "session.toml:13: \"size_m\" is 90, not between 0.005 and 1 m. Next: give it "
            "in m.");
}

TEST(Session, RefusesARateOfZero) {
  EXPECT_TRUE(mistake(with("fps = 10", "fps = 0"))
                  .starts_with("session.toml:33: \"fps\" is 0, not between"));
}

TEST(Session, RefusesABoardWithoutRows) {
  EXPECT_TRUE(mistake(with("rows = 6", "rows = 0"))
                  .starts_with("session.toml:20: \"rows\" is 0, not between"));
}

TEST(Session, RefusesABoardLargerThanItsFamily) {
  EXPECT_TRUE(mistake(with("tag36h11", "tag16h5")).starts_with("session.toml:11: \"id\""))
      << "the body's tag is met first";
  EXPECT_TRUE(mistake(with("first_id = 0", "first_id = 586"))
                  .starts_with("session.toml:24: the board would need tags up to id 615, "
                               "but tag36h11 ends at 586"));
}

TEST(Session, RefusesATagListedTwice) {
  EXPECT_EQ(mistake(with("id = 73", "id = 41")),
            "session.toml:15: tag 41 is listed twice. Next: remove one, or correct its "
            "id.");
}

TEST(Session, RefusesABodyTagThatIsOnTheBoard) {
  EXPECT_TRUE(
      mistake(with("id = 73", "id = 29"))
          .starts_with("session.toml:15: tag 29 is on the body and on the board"));
}

TEST(Session, SuggestsTheNearestSegment) {
  EXPECT_EQ(mistake(with("\"hips\"", "\"Hip\"")),
            "session.toml:12: unknown segment \"Hip\". Next: perhaps you mean \"hips\".");
}

TEST(Session, ListsTheSegmentsWhenNoneIsNear) {
  const std::string message = mistake(with("\"hips\"", "\"pelvis\""));
  EXPECT_NE(message.find("choose one of \"hips\", \"spine\", \"chest\""),
            std::string::npos)
      << message;
}

TEST(Session, SuggestsTheNearestCameraForAnUnknownOneOfVideos) {
  EXPECT_EQ(mistake(with("{ left = \"walk", "{ lift = \"walk")),
            "session.toml:43: unknown camera \"lift\". Next: perhaps you mean \"left\".");
}

TEST(Session, SuggestsTheNearestCameraForAnUnknownOneOfOffsets) {
  EXPECT_EQ(
      mistake(with("{ left = 0.0073", "{ lefty = 0.0073")),
      "session.toml:44: unknown camera \"lefty\". Next: perhaps you mean \"left\".");
}

TEST(Session, RefusesAnOffsetWithoutAVideo) {
  EXPECT_TRUE(mistake(with("{ left = \"walk/left.mp4\", right", "{ right"))
                  .starts_with("session.toml:44: camera \"left\" has an offset but no"));
}

TEST(Session, RefusesACameraNamedTwice) {
  EXPECT_EQ(mistake(with("name = \"left\"", "name = \"right\"")),
            "session.toml:29: camera name \"right\" is used twice. Next: give each its "
            "own name.");
}

TEST(Session, RefusesATrialNamedTwice) {
  EXPECT_TRUE(mistake(with("name = \"walk\"", "name = \"floor\""))
                  .starts_with("session.toml:41: trial name \"floor\" is used twice"));
}

TEST(Session, RefusesNamesThatEscapeTheirFolder) {
  EXPECT_TRUE(mistake(with("name = \"walk\"", "name = \"../walk\""))
                  .starts_with("session.toml:41: trial name \"../walk\" cannot be the "
                               "name of a folder"));
  EXPECT_TRUE(mistake(with("name = \"walk\"", "name = \"..\""))
                  .starts_with("session.toml:41: trial name \"..\" cannot be"));
}

TEST(Session, RefusesACameraNamedLikeATableOfTheCalibration) {
  EXPECT_TRUE(mistake(with("name = \"left\"", "name = \"metadata\""))
                  .starts_with("session.toml:29: camera name \"metadata\" is one of"));
}

TEST(Session, RefusesATrialWithoutVideos) {
  EXPECT_TRUE(
      mistake(with("{ left = \"walk/left.mp4\", right = \"walk/right.mp4\" }", "{}"))
          .starts_with("session.toml:43: trial \"walk\" has no video"));
}

TEST(Session, RefusesOneVideoForTwoCameras) {
  EXPECT_TRUE(mistake(with("right = \"walk/right.mp4\"", "right = \"walk/left.mp4\""))
                  .starts_with("session.toml:43: two cameras have the same video"));
}

TEST(Session, RefusesFramesTheWrongWayRound) {
  EXPECT_TRUE(mistake(with("[0, 7]", "[7, 0]"))
                  .starts_with("session.toml:38: the first frame comes after the last"));
}

TEST(Session, RefusesAnUnknownKind) {
  EXPECT_EQ(
      mistake(with("\"motion\"", "\"motions\"")),
      "session.toml:42: unknown kind \"motions\". Next: perhaps you mean \"motion\".");
}

TEST(Session, NeedsACalibrationTrial) {
  const std::string message = mistake(with("\"calibration\"", "\"motion\""));
  EXPECT_NE(message.find("no trial has the kind \"calibration\""), std::string::npos);
}

TEST(Session, NeedsAFloorTrial) {
  const std::string message = mistake(with("\"floor\"\nframes", "\"motion\"\nframes"));
  EXPECT_NE(message.find("no trial has the kind \"floor\""), std::string::npos);
}

TEST(Session, NeedsTwoCameras) {
  const std::string message = mistake(with("[[camera]]\nname = \"left\"\n", ""));
  EXPECT_NE(message.find("two cameras are needed, found 1"), std::string::npos);
}

TEST(Session, RefusesAFormatItDoesNotKnow) {
  EXPECT_TRUE(mistake(with("format = 1", "format = 2"))
                  .starts_with("session.toml:1: \"format\" is 2"));
}

TEST(Session, AnEmptyFileIsMissingItsFirstKey) {
  EXPECT_TRUE(mistake("").starts_with("session.toml:1: the key \"format\" is missing."));
}

TEST(Session, NamesASessionThatDoesNotExist) {
  const ScratchFolder folder;
  const Result<Session> session = read_session(folder.path());
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().where, folder / "session.toml");
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
  EXPECT_EQ(status.error().cause,
            "trial walk: there is no " + (folder / "videos/walk/right.mp4").string());
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
  const Result<std::string> page =
      read_file(fs::path(MAREY_SOURCE_DIR) / "docs/formats.md");
  ASSERT_TRUE(page);
  constexpr std::string_view kFence = "```toml\n";
  const std::size_t start = page->find(kFence) + kFence.size();
  const std::string example = page->substr(start, page->find("```", start) - start);
  const Result<Session> session = read(example);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->trials.size(), 3U);
}

const fs::path kSample = fs::path(MAREY_SOURCE_DIR) / "recordings/samples/blender-dev";

TEST(SampleSession, IsRead) {
  const Result<Session> session = read_session(kSample);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->tags.size(), 29U);
  EXPECT_EQ(session->cameras.size(), 4U);
  EXPECT_EQ(session->trials.size(), 7U);
}

TEST(SampleSession, HasAllItsVideos) {
  const fs::path data = fs::path(MAREY_SHARED_DATA) / "blender/dev";
  if (!fs::exists(data)) GTEST_SKIP() << "the recording blender/dev is not here";
  const Result<Session> session = read_session(kSample, {.media = data});
  ASSERT_TRUE(session) << session.error().message();
  const Status status = check_files(*session);
  EXPECT_TRUE(status) << status.error().message();
}

}  // namespace
}  // namespace marey::recordings
