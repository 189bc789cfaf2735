// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/constraints_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/recordings/body/constraint_text.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using namespace testing;

/// One of every type, all numbers different, none with a short decimal form.
ConstraintSet one_of_each() {
  const glm::dquat turned = glm::normalize(glm::dquat(0.7, -0.1, 0.2, 1.0 / 3.0));
  ConstraintSet set;
  const auto add = [&](std::string id, std::string segment, Goal goal) -> Constraint& {
    Constraint& added = set.constraints.emplace_back();
    added.id = std::move(id);
    added.point = {std::move(segment), {0.1, -0.2 / 3, 0.3}};
    added.goal = std::move(goal);
    return added;
  };
  set.constraints.reserve(8);
  Constraint& reach = add("reach", "rightHand", DistanceToPoint{0.1 / 3, {1e-9, -2, 3}});
  reach.range = 4;
  reach.importance = 2.0 / 3.0;
  reach.precision_m = 1e-7 / 3.0;
  reach.activation = {0.5 / 3.0, 0.8 / 7.0, 0.1 / 9.0, 0.2 / 11.0};
  add("clap", "leftHand", DistanceToBody{0.0, {"rightHand", {0.1, 0.0, -1e-300}}});
  add("a < b & \"c\" é", "leftFoot", DistanceToConstraint{0.25, "reach"});
  add("above", "leftLowerArm", AllowedSpace{{-1, 0.7, -1}, {1, 2, 1}});
  add("table", "rightLowerArm", ForbiddenSpace{{-1, 0, 0.1}, {1, 0.7, 1}});
  add("tray", "leftHand", SegmentOrientation{turned});
  add("stands", "leftFoot", Support{}).activation.stop_s = -3.0;
  add("treads", "rightFoot", Support{glm::dvec3(0.1, 0.08, 0.2), turned});
  return set;
}

std::string text_of(const ConstraintSet& set) {
  const Result<std::string> text = constraints_text(set);
  EXPECT_TRUE(text) << text.error().message();
  return text ? *text : "";
}

ConstraintFile read(const std::string& text) {
  const auto file = parse_constraints(text, "c.xml");
  EXPECT_TRUE(file) << file.error().message();
  return file ? *file : ConstraintFile{};
}

TEST(ConstraintsFile, ReadsTheExampleOfTheThesis) {
  const auto file = read_constraints(kAnnex);
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_TRUE(file->notes.empty());
  ASSERT_EQ(file->set.constraints.size(), 1U);
  const Constraint* parry = file->set.find("ctrParade");
  ASSERT_NE(parry, nullptr);
  EXPECT_EQ(parry->importance, 3.0);
  EXPECT_EQ(parry->precision_m, 0.001);
  EXPECT_EQ(parry->activation.start_s, 0.499995);
  EXPECT_EQ(parry->activation.stop_s, 0.799992);
  EXPECT_EQ(parry->activation.start_duration_s, 0.119999);
  EXPECT_EQ(parry->activation.stop_duration_s, 0.122574);
  EXPECT_EQ(parry->range, 6);
  EXPECT_EQ(parry->point.segment, "rightShoulder");
  EXPECT_EQ(parry->point.offset_in_t_pose, glm::dvec3(0, 0.04, 0.13));
  const auto* goal = std::get_if<DistanceToPoint>(&parry->goal);
  ASSERT_NE(goal, nullptr);
  EXPECT_EQ(goal->distance_m, 0.0);
  EXPECT_EQ(goal->p_in_world, glm::dvec3(0.0));
}

// The writer uses the annex' form: all but the segment's name is unchanged.
TEST(ConstraintsFile, WritesTheExampleOfTheThesisAsItWas) {
  EXPECT_EQ(text_of(read(annex()).set),
            annex_with("rightSternoClavicular", "rightShoulder"));
}

TEST(ConstraintsFile, GivesBackEveryDoubleOfEveryType) {
  const ConstraintSet written = one_of_each();
  const ConstraintFile file = read(text_of(written));
  EXPECT_TRUE(file.notes.empty());
  ASSERT_EQ(file.set.constraints.size(), written.constraints.size());
  for (std::size_t i = 0; i < written.constraints.size(); ++i) {
    const Constraint& a = written.constraints[i];
    const Constraint& b = file.set.constraints[i];
    SCOPED_TRACE(a.id);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.point.segment, b.point.segment);
    EXPECT_EQ(a.point.offset_in_t_pose, b.point.offset_in_t_pose);
    EXPECT_EQ(a.range, b.range);
    EXPECT_EQ(a.importance, b.importance);
    EXPECT_EQ(a.precision_m, b.precision_m);
    EXPECT_EQ(a.activation.start_s, b.activation.start_s);
    EXPECT_EQ(a.activation.stop_s, b.activation.stop_s);
    EXPECT_EQ(a.activation.start_duration_s, b.activation.start_duration_s);
    EXPECT_EQ(a.activation.stop_duration_s, b.activation.stop_duration_s);
    EXPECT_EQ(a.goal.index(), b.goal.index());
  }
  const auto& c = file.set.constraints;
  EXPECT_EQ(std::get<DistanceToPoint>(c[0].goal).distance_m, 0.1 / 3);
  EXPECT_EQ(std::get<DistanceToPoint>(c[0].goal).p_in_world, glm::dvec3(1e-9, -2, 3));
  EXPECT_EQ(std::get<DistanceToBody>(c[1].goal).other.segment, "rightHand");
  EXPECT_EQ(std::get<DistanceToBody>(c[1].goal).other.offset_in_t_pose,
            glm::dvec3(0.1, 0.0, -1e-300));
  EXPECT_EQ(std::get<DistanceToConstraint>(c[2].goal).distance_m, 0.25);
  EXPECT_EQ(std::get<DistanceToConstraint>(c[2].goal).other_id, "reach");
  EXPECT_EQ(std::get<AllowedSpace>(c[3].goal).min_in_world, glm::dvec3(-1, 0.7, -1));
  EXPECT_EQ(std::get<AllowedSpace>(c[3].goal).max_in_world, glm::dvec3(1, 2, 1));
  EXPECT_EQ(std::get<ForbiddenSpace>(c[4].goal).min_in_world, glm::dvec3(-1, 0, 0.1));
  EXPECT_EQ(std::get<ForbiddenSpace>(c[4].goal).max_in_world, glm::dvec3(1, 0.7, 1));
  const glm::dquat turned = std::get<SegmentOrientation>(c[5].goal).world_from_t_pose;
  EXPECT_EQ(turned,
            std::get<SegmentOrientation>(written.constraints[5].goal).world_from_t_pose);
  EXPECT_FALSE(std::get<Support>(c[6].goal).footprint_in_world);
  EXPECT_FALSE(std::get<Support>(c[6].goal).world_from_t_pose);
  EXPECT_EQ(std::get<Support>(c[7].goal).footprint_in_world, glm::dvec3(0.1, 0.08, 0.2));
  EXPECT_EQ(std::get<Support>(c[7].goal).world_from_t_pose, turned);
}

TEST(ConstraintsFile, WritesTheSameBytesAfterReadingThem) {
  ConstraintSet set = one_of_each();
  set.unknown_xml = {"<Gaze x='1>2'><!-- </Gaze> --><at/><![CDATA[</Gaze>]]></Gaze>"};
  set.constraints[0].unknown_xml = {"<colour >red\n  &amp; blue</colour>"};
  const std::string first = text_of(set);
  EXPECT_EQ(text_of(read(first).set), first);
}

TEST(ConstraintsFile, UsesDefaultsForOmittedAttributes) {
  const ConstraintFile file = read(
      "<ConstraintsSet><Support><name>s</name><bodyPoint><segment>leftFoot</segment>"
      "</bodyPoint></Support></ConstraintsSet>");
  ASSERT_EQ(file.set.constraints.size(), 1U);
  const Constraint& stands = file.set.constraints[0];
  EXPECT_EQ(stands.importance, Constraint{}.importance);
  EXPECT_EQ(stands.precision_m, Constraint{}.precision_m);
  EXPECT_FALSE(stands.range);
  EXPECT_FALSE(stands.activation.start_s);
  EXPECT_FALSE(stands.activation.stop_s);
  EXPECT_EQ(stands.activation.start_duration_s, 0.0);
  EXPECT_EQ(stands.point.offset_in_t_pose, glm::dvec3(0.0));
}

TEST(ConstraintsFile, KeepsAndReportsUnknownElements) {
  const std::string gaze = "<Gaze>\n    <name>g</name><at x=\"/\" y='>'/>\n  </Gaze>";
  const std::string colour = "<acuracy unit = \"m\">0.1<!-- </acuracy> --></acuracy>";
  std::string text = annex_with("<priority>", colour + "\n    <priority>");
  text.replace(text.find("  <Distance>"), 2, "  " + gaze + "\n  ");
  const ConstraintFile file = read(text);
  ASSERT_EQ(file.set.unknown_xml, std::vector{gaze});
  ASSERT_EQ(file.set.constraints.size(), 1U);
  ASSERT_EQ(file.set.constraints[0].unknown_xml, std::vector{colour});
  ASSERT_EQ(file.notes.size(), 2U);
  EXPECT_EQ(file.notes[0],
            "c.xml:8: <acuracy> is unknown here and is kept as it is; perhaps you mean "
            "\"accuracy\"");
  EXPECT_EQ(file.notes[1], "c.xml:3: <Gaze> is unknown here and is kept as it is");
  const std::string written = text_of(file.set);
  EXPECT_NE(written.find("\n    " + colour + "\n  </Distance>"), std::string::npos);
  EXPECT_NE(written.find("\n  " + gaze + "\n</ConstraintsSet>"), std::string::npos);
}

TEST(ConstraintsFile, ReportsUnknownContentThatItDoesNotKeep) {
  const ConstraintFile file =
      read(annex_with("<localOffset>", "<localOffset unit=\"mm\"><W/>"));
  ASSERT_EQ(file.notes.size(), 2U);
  EXPECT_EQ(file.notes[0],
            "c.xml:14: <localOffset> has an attribute \"unit\", which is not kept");
  EXPECT_NE(file.notes[1].find("<W> is unknown here and is not kept"), std::string::npos);
}

TEST(ConstraintsFile, ReportsTwentyNotesAndTheNumberOfTheOthers) {
  std::string text = "<ConstraintsSet>";
  for (int i = 0; i < 25; ++i) text += "<Odd/>";
  const ConstraintFile file = read(text + "</ConstraintsSet>");
  ASSERT_EQ(file.notes.size(), 21U);
  EXPECT_EQ(file.notes.back(), "c.xml: 5 more notes are left out");
  EXPECT_EQ(file.set.unknown_xml.size(), 25U);
}

// A quarter turn about X converts Z up to Y up: (x, y, z) is (x, z, -y) there.
TEST(ConstraintsFile, TurnsAWorldWithZUp) {
  const std::string head =
      "<ConstraintsSet up=\"Z\"><AllowedSpace><name>a</name><bodyPoint>"
      "<segment>leftHand</segment><localOffset><X>1</X><Y>2</Y><Z>3</Z></localOffset>"
      "</bodyPoint><specif><min><X>1</X><Y>2</Y><Z>3</Z></min>"
      "<max><X>4</X><Y>5</Y><Z>6</Z></max></specif></AllowedSpace>";
  // A quarter turn about the file's vertical.
  const std::string tail =
      "<Orientation><name>o</name><bodyPoint><segment>head</segment></bodyPoint><specif>"
      "<orientation><W>0.70710678</W><X>0</X><Y>0</Y><Z>0.70710678</Z></orientation>"
      "</specif></Orientation></ConstraintsSet>";
  const ConstraintFile file = read(head + tail);
  ASSERT_EQ(file.set.constraints.size(), 2U);
  EXPECT_EQ(file.set.constraints[0].point.offset_in_t_pose, glm::dvec3(1, 3, -2));
  const auto& space = std::get<AllowedSpace>(file.set.constraints[0].goal);
  EXPECT_EQ(space.min_in_world, glm::dvec3(1, 3, -5));
  EXPECT_EQ(space.max_in_world, glm::dvec3(4, 6, -2));
  const glm::dquat about_y =
      std::get<SegmentOrientation>(file.set.constraints[1].goal).world_from_t_pose;
  const glm::dvec3 turned = about_y * glm::dvec3(0, 0, 1);
  EXPECT_LT(glm::distance(turned, glm::dvec3(1, 0, 0)), 1e-15 /* made unit, so exact */);
  const std::string written = text_of(file.set);
  EXPECT_EQ(written.find("up="), std::string::npos);
  EXPECT_EQ(text_of(read(written).set), written);
}

TEST(ConstraintsFile, TakesS4DMakersNamesForVrms) {
  const auto segment = [](const std::string& name) {
    return read(annex_with("rightSternoClavicular", name))
        .set.constraints[0]
        .point.segment;
  };
  EXPECT_EQ(segment("leftForearm"), "leftLowerArm");
  EXPECT_EQ(segment("rightThigh"), "rightUpperLeg");
  EXPECT_EQ(segment("pelvis"), "hips");
  EXPECT_EQ(segment("leftLowerArm"), "leftLowerArm");
  EXPECT_EQ(segment("tail_03"), "tail_03");
}

TEST(ConstraintsFile, RefusesANonUnitQuaternionAndNormalizesARoundedOne) {
  const auto orientation = [](const std::string& w) {
    return "<ConstraintsSet><Orientation><name>o</name><bodyPoint><segment>head</segment>"
           "</bodyPoint>\n<specif><orientation><W>" +
           w +
           "</W><X>0</X><Y>0.6</Y><Z>0</Z></orientation></specif></Orientation>"
           "</ConstraintsSet>";
  };
  EXPECT_EQ(
      refusal(orientation("0.5")),
      "c.xml:2: <orientation> is not a unit quaternion. Next: divide it by its length.");
  const ConstraintFile file = read(orientation("0.8001"));
  const auto& goal = std::get<SegmentOrientation>(file.set.constraints[0].goal);
  EXPECT_NEAR(glm::length(goal.world_from_t_pose), 1.0, 1e-15 /* rounding alone */);
  const std::string written = text_of(file.set);
  EXPECT_EQ(text_of(read(written).set), written);
}

TEST(ConstraintsFile, RefusesToWriteUnreadableConstraints) {
  const auto refused = [](auto&& change) {
    ConstraintSet set = one_of_each();
    change(set);
    const auto text = constraints_text(set);
    return text ? "no refusal" : text.error().message();
  };
  EXPECT_EQ(refused([](ConstraintSet& set) {
              set.constraints[1].precision_m = std::numeric_limits<double>::infinity();
            }),
            "constraint \"clap\": cannot be written: <accuracy> is \"inf\", which is not "
            "a number. Next: write a number, with a decimal point.");
  EXPECT_EQ(
      refused([](ConstraintSet& set) { set.constraints[1].id = ""; }),
      "constraint \"\": cannot be written: <name> is empty. Next: give it a value.");
  EXPECT_NE(refused([](ConstraintSet& set) {
              set.constraints[1].id = "a ";
            }).find("it would be read as something else"),
            std::string::npos);
  EXPECT_NE(refused([](ConstraintSet& set) {
              set.constraints[1].id = "reach";
            }).find("a constraint named \"reach\" is on line"),
            std::string::npos);
  EXPECT_NE(refused([](ConstraintSet& set) {
              set.unknown_xml = {"<a/><b/>"};
            }).find("one XML element in each text of unknown_xml"),
            std::string::npos);
  EXPECT_NE(refused([](ConstraintSet& set) {
              set.unknown_xml = {"<a>"};
            }).find("cannot be written: not valid XML"),
            std::string::npos);
}

TEST(ConstraintsFile, WritesAFileThatReadsBack) {
  const testing::ScratchFolder folder;
  const auto path = folder / "sub/walk.constraints.xml";
  const Status written = write_constraints(path, one_of_each());
  ASSERT_TRUE(written) << written.error().message();
  const auto file = read_constraints(path);
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_EQ(text_of(file->set), text_of(one_of_each()));
  ConstraintSet broken = one_of_each();
  broken.constraints[0].id = "";
  EXPECT_FALSE(write_constraints(path, broken));
  EXPECT_EQ(text_of(read_constraints(path)->set), text_of(one_of_each()));
}

TEST(ConstraintsFile, ReportsAMissingOrTooLargeFile) {
  const testing::ScratchFolder folder;
  const auto none = read_constraints(folder / "none.xml");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("the file does not exist"), std::string::npos);
  const auto path = folder / "big.xml";
  std::ofstream(path) << "<ConstraintsSet/>";
  std::filesystem::resize_file(path, (std::size_t{16} << 20) + 1);
  const auto big = read_constraints(path);
  ASSERT_FALSE(big);
  EXPECT_NE(big.error().message().find("16 MiB"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
