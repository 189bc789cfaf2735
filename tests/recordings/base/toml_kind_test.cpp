// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A TOML file of another kind is named as what it is.
#include "recordings/base/toml_kind.h"

#include <string>

#include <gtest/gtest.h>

#include "core/skeleton.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/bone_map_file.h"
#include "recordings/body/character_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/markers/marker_map.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/plan_file.h"
#include "recordings/session/session.h"
#include "recordings/session/subject_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

constexpr const char* kCalibrationText =
    "[cam0]\nname = \"cam0\"\nmatrix = [[1.0, 0.0, 0.0]]\n";
constexpr const char* kSubjectText =
    "format = 1\nname = \"a\"\n[tips]\nhead = [0.0, 0.1, 0.0]\n[[joint]]\n[[tag]]\nid = "
    "1\n";
constexpr const char* kPlanText =
    "format = 1\ntag_size_m = 0.08\n[[camera]]\nname = \"cam0\"\n";
constexpr const char* kSessionText =
    "format = 1\nname = \"s\"\n[subject]\nname = \"a\"\n[board]\n[[trial]]\n";

template <class T>
std::string refusal_of(const Result<T>& read) {
  return read ? "no refusal" : read.error().message();
}

std::string session_refusal(const std::string& text) {
  const testing::ScratchFolder folder;
  const auto path = folder / "session.toml";
  EXPECT_TRUE(write_file(path, text));
  const auto session = read_session(path);
  if (session) return "no refusal";
  EXPECT_TRUE(session.error().where.starts_with(path.string()));
  return session.error().cause;
}

TEST(TomlKind, IsNamedInPlaceOfASession) {
  EXPECT_EQ(session_refusal(kCalibrationText), "this is a calibration, not a session");
  EXPECT_EQ(session_refusal(kSubjectText), "this is a subject, not a session");
  EXPECT_EQ(session_refusal(kPlanText), "this is a plan, not a session");
  EXPECT_EQ(session_refusal("format = 1\nbase_m = 0.1\n"),
            "this is a floor, not a session");
  EXPECT_EQ(session_refusal("[markers]\nLASI = \"left_asis\"\n"),
            "this is a map of marker labels, not a session");
  EXPECT_EQ(session_refusal("[bones]\nhips = \"Hips\"\n"),
            "this is a bone map, not a session");
  EXPECT_EQ(session_refusal("format = 1\navatar = \"a.glb\"\nsubject = \"s.toml\"\n"),
            "this is a character, not a session");
  EXPECT_EQ(session_refusal("format = 1\n[source]\npath = \"a.bvh\"\n"),
            "this is a recipe of edits, not a session");
}

TEST(TomlKind, IsNamedByEveryReader) {
  const std::string next = " as docs/formats/";
  EXPECT_EQ(refusal_of(parse_subject(kPlanText, "a.toml")),
            "a.toml: this is a plan, not a subject. Next: give a subject" + next +
                "subject.md describes it.");
  EXPECT_EQ(refusal_of(parse_plan(kSubjectText, "a.toml")),
            "a.toml: this is a subject, not a plan. Next: give a plan" + next +
                "plan.md describes it.");
  EXPECT_EQ(refusal_of(parse_calibration(kSessionText, "a.toml")),
            "a.toml: this is a session, not a calibration. Next: give a calibration" +
                next + "calibration.md describes it.");
  EXPECT_EQ(refusal_of(parse_character_spec(kCalibrationText, "a.toml")),
            "a.toml: this is a calibration, not a character. Next: give a character" +
                next + "character.md describes it.");
  EXPECT_EQ(refusal_of(parse_floor(kSessionText, "a.toml")),
            "a.toml: this is a session, not a floor. Next: give a floor" + next +
                "floor.md describes it.");
  EXPECT_EQ(refusal_of(parse_marker_map(kSubjectText, "a.toml")),
            "a.toml: this is a subject, not a map of marker labels. Next: give a map of "
            "marker labels" +
                next + "markers.md describes it.");
  EXPECT_EQ(refusal_of(parse_bone_map(kSessionText, "a.toml", Skeleton{})),
            "a.toml: this is a session, not a bone map. Next: give a bone map" + next +
                "bodies.md describes it.");
}

TEST(TomlKind, DoesNotHideAMistakeInAFileOfTheRightKind) {
  EXPECT_TRUE(session_refusal("format = 1\nname = \"s\"\nbase_m = 1\n[board]\n")
                  .starts_with("unknown key \"base_m\""));
  EXPECT_TRUE(refusal_of(parse_plan(std::string("board = 1\n") + kPlanText, "a.toml"))
                  .starts_with("a.toml:1: unknown key \"board\""));
}

TEST(TomlKind, AFileWithoutKeysIsCalledEmpty) {
  EXPECT_EQ(session_refusal(""), "the file is empty");
  EXPECT_EQ(refusal_of(parse_floor("", "a.toml")),
            "a.toml: the file is empty. Next: copy or export it again.");
  EXPECT_EQ(refusal_of(parse_calibration("# a comment\n", "a.toml")),
            "a.toml: the file is empty. Next: copy or export it again.");
}

}  // namespace
}  // namespace marey::recordings
