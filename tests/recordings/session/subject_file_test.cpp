// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/subject_file.h"

#include <string>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

Body a_body() {
  Body body;
  body.name = "S 16 \"é\"";
  body.stature_m = 1.734;
  body.mass_kg = 70.0 / 3.0;
  body.proportions = average_proportions(1.734);
  for (std::size_t i = 0; i < body.joint_centre_sigma_m.size(); ++i) {
    body.joint_centre_sigma_m[i] = 0.001 * static_cast<double>(i) / 7.0;
  }
  for (std::size_t limb = 0; limb < body.hinges.size(); ++limb) {
    const double number = static_cast<double>(limb + 1);
    body.hinges[limb] = {0.1 / (3.0 * number), -0.2 / (7.0 * number), 1e-3 / number};
  }
  const glm::dquat rotation = rotation_from_vector({0.1, -0.2, 3.0});
  body.tags.push_back(
      {.tag = {TagId{41}, HumanBone::kHips, 0.09},
       .segment_from_tag = {rotation, {0.1 / 3.0, -0.2 / 7.0, 1e-9 / 3.0}},
       .sigma_m = 0.002 / 3.0,
       .sigma_rad = 0.01 / 7.0,
       .sightings = 321});
  PlacedTag unplaced;
  unplaced.tag = {TagId{73}, HumanBone::kHead, 0.075};
  body.tags.push_back(unplaced);
  body.markers.push_back({"LASI \"2\"",
                          HumanBone::kHips,
                          {0.1 / 3.0, 1e-9 / 7.0, -0.2},
                          0.004 / 3.0,
                          0.009 / 7.0,
                          4321});
  body.markers.push_back({"RTOE", HumanBone::kRightFoot});
  body.warnings.push_back(fair_finding("",
                                       "",
                                       "the tags on segment \"leftFoot\" fit in two ways",
                                       "turn that segment slowly before two cameras"));
  return body;
}

std::string subject_mistake(std::string_view from, std::string_view to) {
  const Result<Body> body =
      parse_subject(testing::replace_first(subject_text(a_body()), from, to), "s.toml");
  return body ? "" : body.error().message();
}

TEST(SubjectFile, GivesBackEveryDoubleOfTheSkeleton) {
  const Body written = a_body();
  const Result<Body> read = parse_subject(subject_text(written), "s.toml");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->name, written.name);
  EXPECT_EQ(read->stature_m, written.stature_m);
  EXPECT_EQ(read->mass_kg, written.mass_kg);
  const Proportions& a = written.proportions;
  const Proportions& b = read->proportions;
  EXPECT_EQ(a.offset_in_parent, b.offset_in_parent);
  EXPECT_EQ(a.head_top_in_head, b.head_top_in_head);
  EXPECT_EQ(a.left_hand_tip_in_hand, b.left_hand_tip_in_hand);
  EXPECT_EQ(a.right_hand_tip_in_hand, b.right_hand_tip_in_hand);
  EXPECT_EQ(a.left_toe_tip_in_toes, b.left_toe_tip_in_toes);
  EXPECT_EQ(a.right_toe_tip_in_toes, b.right_toe_tip_in_toes);
  EXPECT_EQ(written.joint_centre_sigma_m, read->joint_centre_sigma_m);
  ASSERT_EQ(read->warnings.size(), written.warnings.size());
  EXPECT_EQ(read->warnings.front().cause, written.warnings.front().cause);
  EXPECT_EQ(read->warnings.front().next, written.warnings.front().next);
  for (std::size_t limb = 0; limb < written.hinges.size(); ++limb) {
    EXPECT_EQ(written.hinges[limb].upper_rad, read->hinges[limb].upper_rad);
    EXPECT_EQ(written.hinges[limb].lower_rad, read->hinges[limb].lower_rad);
    EXPECT_EQ(written.hinges[limb].rollback_m, read->hinges[limb].rollback_m);
  }
}

TEST(SubjectFile, ReadsMissingHingesAsStraight) {
  std::string text = subject_text(a_body());
  const std::size_t from = text.find("[hinge]");
  ASSERT_NE(from, std::string::npos);
  text.erase(from, text.find("[[tag]]", from) - from);
  const Result<Body> read = parse_subject(text, "s.toml");
  ASSERT_TRUE(read) << read.error().message();
  for (const HingeShape& hinge : read->hinges) EXPECT_EQ(hinge.upper_rad, 0.0);
}

TEST(SubjectFile, DeclinesAHingeOfAnotherJoint) {
  EXPECT_NE(subject_mistake("left_knee", "left_hip").find("unknown key \"left_hip\""),
            std::string::npos);
}

TEST(SubjectFile, GivesBackEveryDoubleOfTheTags) {
  const Body written = a_body();
  const Result<Body> read = parse_subject(subject_text(written), "s.toml");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->tags.size(), 2U);
  const PlacedTag& a = written.tags[0];
  const PlacedTag& b = read->tags[0];
  EXPECT_EQ(a.tag.id, b.tag.id);
  EXPECT_EQ(a.tag.segment, b.tag.segment);
  EXPECT_EQ(a.tag.size_m, b.tag.size_m);
  EXPECT_EQ(a.segment_from_tag.rotation, b.segment_from_tag.rotation);
  EXPECT_EQ(a.segment_from_tag.translation, b.segment_from_tag.translation);
  EXPECT_EQ(a.sigma_m, b.sigma_m);
  EXPECT_EQ(a.sigma_rad, b.sigma_rad);
  EXPECT_EQ(a.sightings, b.sightings);
}

TEST(SubjectFile, GivesBackEveryDoubleOfTheMarkers) {
  const Body written = a_body();
  const Result<Body> read = parse_subject(subject_text(written), "s.toml");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->markers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const PlacedMarker& a = written.markers[i];
    const PlacedMarker& b = read->markers[i];
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.segment, b.segment);
    EXPECT_EQ(a.p_in_segment, b.p_in_segment);
    EXPECT_EQ(a.sigma_m, b.sigma_m);
    EXPECT_EQ(a.stray_m, b.stray_m);
    EXPECT_EQ(a.frames, b.frames);
  }
}

TEST(SubjectFile, KeepsAMassThatIsNotKnownUnknown) {
  Body body = a_body();
  body.mass_kg.reset();
  const Result<Body> read = parse_subject(subject_text(body), "s.toml");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->mass_kg);
}

TEST(SubjectFile, IsReadFromDisk) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_subject(folder / "subject.toml", a_body()));
  const Result<Body> read = read_subject(folder / "subject.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(subject_text(*read), subject_text(a_body()));
}

TEST(SubjectFile, RefusesAnUnknownKey) {
  EXPECT_EQ(subject_mistake("stature_m", "statura_m"),
            "s.toml:5: unknown key \"statura_m\". Next: perhaps you mean \"stature_m\".");
}

TEST(SubjectFile, RefusesAJointTooFew) {
  EXPECT_NE(subject_mistake("[joint.leftFoot]", "[joint.leftfoot]")
                .find("unknown joint \"leftfoot\". Next: perhaps you mean \"leftFoot\"."),
            std::string::npos);
}

TEST(SubjectFile, RefusesAnotherParent) {
  EXPECT_NE(subject_mistake("parent = \"hips\"", "parent = \"head\"")
                .find("the parent must be \"hips\""),
            std::string::npos);
}

TEST(SubjectFile, RefusesALengthThatIsNotTheOffsets) {
  EXPECT_NE(subject_mistake("length_m = 0.", "length_m = 1.")
                .find("\"length_m\" is not the length of \"offset_in_parent_m\""),
            std::string::npos);
}

TEST(SubjectFile, RefusesATagTwice) {
  EXPECT_NE(subject_mistake("id = 73", "id = 41").find("this tag is listed twice"),
            std::string::npos);
}

TEST(SubjectFile, RefusesAMarkerTwiceOrWithoutALabel) {
  EXPECT_NE(subject_mistake("label = \"RTOE\"", "label = \"LASI \\\"2\\\"\"")
                .find("this marker is listed twice"),
            std::string::npos);
  EXPECT_NE(
      subject_mistake("label = \"RTOE\"", "label = \"\"").find("the label is empty"),
      std::string::npos);
}

TEST(SubjectFile, RejectsAnInvalidRotation) {
  EXPECT_NE(subject_mistake("rotation_wxyz = [1.0", "rotation_wxyz = [2.0")
                .find("\"rotation_wxyz\" is not a unit quaternion"),
            std::string::npos);
}

TEST(SubjectFile, RefusesANegativeSigma) {
  EXPECT_NE(subject_mistake("sigma_rad = ", "sigma_rad = -").find("\"sigma_rad\" is -"),
            std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
