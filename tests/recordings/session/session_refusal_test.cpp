// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "recordings/session/session.h"
#include "tests/recordings/session_text.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

TEST(Session, NamesTheLineThatIsNotToml) {
  const std::string message = mistake(with("rows = 6", "rows = = 6"));
  EXPECT_TRUE(message.starts_with("session.toml:20: not valid TOML: ")) << message;
}

TEST(Session, NamesAMissingKey) {
  EXPECT_EQ(
      mistake(with("stature_m = 1.734\n", "")),
      "session.toml:4: the key \"stature_m\" is missing in [subject]. Next: add it; "
      "docs/formats/session.md describes it.");
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
            "docs/formats/session.md shows.");
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

TEST(Session, RefusesSlowMotionWithoutTheRateOfThePictures) {
  EXPECT_TRUE(mistake(with("fps = 10", "slow_motion = 4"))
                  .starts_with("session.toml:33: \"slow_motion\" has no \"fps\""));
  EXPECT_TRUE(mistake(with("fps = 10", "fps = 10\nslow_motion = 1"))
                  .starts_with("session.toml:34: \"slow_motion\" is 1, not between"));
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

/// kSession with a second motion trial of these keys.
std::string with_run(std::string_view keys) {
  return std::string(kSession) + "[[trial]]\nname = \"run\"\nkind = \"motion\"\n" +
         std::string(keys);
}

TEST(Session, RefusesTheSameFramesInTwoTrials) {
  EXPECT_EQ(
      mistake(with_run("videos = { left = \"walk/left.mp4\" }\n")),
      "session.toml:48: trial \"walk\" has the same frames of \"left.mp4\". Next: "
      "name this trial's own videos; where one video holds several trials, give each "
      "of them its frames = [FIRST, LAST].");
  EXPECT_NE(mistake(with("\"floor\"\nframes = [0, 7]\n", "\"static\"\n"))
                .find("trial \"calib\" has the same frames of"),
            std::string::npos);
}

TEST(Session, AcceptsOneVideoCutIntoTrials) {
  EXPECT_EQ(
      mistake(with_run("frames = [0, 99]\nvideos = { left = \"walk/left.mp4\" }\n")), "");
}

TEST(Session, RefusesACamerasVideoAsAnothersOfAnotherTrial) {
  EXPECT_TRUE(mistake(with_run("videos = { right = \"walk/left.mp4\" }\n"))
                  .starts_with("session.toml:48: trial \"walk\" has the video "
                               "\"left.mp4\" for another camera"));
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

TEST(Session, RefusesASecondTrialOfAKindThatIsAlone) {
  EXPECT_TRUE(mistake(with("kind = \"floor\"", "kind = \"calibration\""))
                  .starts_with("session.toml:37: trial \"calib\" already has the kind "
                               "\"calibration\""));
}

TEST(Session, RefusesOffsetsOutsideMotionTrials) {
  EXPECT_TRUE(mistake(with("[0, 7]\n", "[0, 7]\ntime_offset_s = { left = 0.1 }\n"))
                  .starts_with("session.toml:39: time offsets are for motion trials"));
}

TEST(Session, RefusesAFloorThatIsTheWholeOfAVideoInWhichTheBoardMoves) {
  EXPECT_TRUE(mistake(with("frames = [0, 7]\n", ""))
                  .starts_with("session.toml:37: trial \"floor\" is the whole of a video "
                               "of trial \"calib\""));
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

TEST(Session, AnEmptyFileIsCalledEmpty) {
  EXPECT_TRUE(mistake("").starts_with("session.toml: the file is empty."));
}

TEST(Session, NamesASessionThatDoesNotExist) {
  const ScratchFolder folder;
  const Result<Session> session = read_session(folder.path());
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().where, folder / "session.toml");
}

}  // namespace
}  // namespace marey::recordings
