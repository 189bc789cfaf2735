// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/character_file.h"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;
using B = HumanBone;

// The example of docs/formats/character.md: the first toml block after its heading.
std::string documented() {
  return marey::testing::formats_example("character");
}

CharacterSpec parsed(const std::string& text) {
  const Result<CharacterSpec> spec = parse_character_spec(text, "c.toml");
  EXPECT_TRUE(spec) << (spec ? "" : spec.error().message());
  return spec ? *spec : CharacterSpec{};
}

std::string mistake(const std::string& from, const std::string& to) {
  const auto spec =
      parse_character_spec(testing::replace_first(documented(), from, to), "c.toml");
  return spec ? "" : spec.error().message();
}

bool says(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
  return message.find(part) != std::string::npos;
}

TEST(CharacterFile, ReadsTheExampleOfTheDocumentation) {
  const CharacterSpec spec = parsed(documented());
  EXPECT_EQ(spec.name, "Ann");
  ASSERT_TRUE(std::holds_alternative<AvatarBody>(spec.body));
  EXPECT_EQ(std::get<AvatarBody>(spec.body).path, "../avatars/ann.vrm");
  const CharacterTraits& traits = spec.traits;
  EXPECT_EQ(traits.mass.table, MassTable::kDeLevaFemale);
  EXPECT_EQ(traits.mass.total_kg, 61.5);
  EXPECT_EQ(traits.mass.segment_kg[index(B::kLeftFoot)], 0.4);
  EXPECT_FALSE(traits.mass.segment_kg[index(B::kHips)]);
  EXPECT_TRUE(traits.has_limits);
  ASSERT_EQ(traits.limits.size(), 1U);
  EXPECT_EQ(traits.limits[0].bone, B::kLeftLowerLeg);
  EXPECT_DOUBLE_EQ(traits.limits[0].max_rad.x, 95.0 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(traits.limits[0].min_rad.z, -10.0 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(traits.flexibility.min_trunk_thigh_angle_rad,
                   80.0 * kRadiansPerDegree);
  EXPECT_DOUBLE_EQ(traits.flexibility.straight_knee_rad, 10.0 * kRadiansPerDegree);
  ASSERT_EQ(traits.loads.size(), 1U);
  EXPECT_EQ(traits.loads[0].name, "bag");
  EXPECT_EQ(traits.loads[0].point.segment, "leftHand");
  EXPECT_EQ(traits.loads[0].point.offset_in_t_pose, glm::dvec3(0.08, -0.3, 0.0));
  EXPECT_EQ(traits.loads[0].mass_kg, 5.0);
}

CharacterSpec a_character() {
  CharacterSpec spec;
  spec.name = "Ann \"é\"";
  spec.body = AverageBody{1.6 / 3.0 + 1.0};
  CharacterTraits& traits = spec.traits;
  traits.mass.table = MassTable::kDeLevaMale;
  traits.mass.total_kg = 200.0 / 3.0;
  traits.mass.segment_kg[index(B::kHips)] = 100.0 / 3.0;
  traits.mass.segment_kg[index(B::kRightHand)] = 0.0;
  traits.has_limits = false;
  traits.limits.push_back({B::kSpine,
                           glm::dvec3(-10.1, -170.0 / 3.0, -180.0) * kRadiansPerDegree,
                           glm::dvec3(0.3, 0.1, 180.0) * kRadiansPerDegree});
  traits.flexibility = {77.7 * kRadiansPerDegree, 9.1 * kRadiansPerDegree};
  traits.loads.push_back({"bag", {"leftHand", {0.1 / 3.0, -1e-9 / 7.0, 0.0}}, 5.0 / 3.0});
  traits.loads.push_back({"hat", {"some joint", {0.0, 0.0, 0.0}}, 0.0});
  return spec;
}

TEST(CharacterFile, GivesBackEveryDouble) {
  const CharacterSpec written = a_character();
  const CharacterSpec read = parsed(character_spec_text(written));
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(std::get<AverageBody>(read.body).stature_m,
            std::get<AverageBody>(written.body).stature_m);
  const CharacterTraits& a = written.traits;
  const CharacterTraits& b = read.traits;
  EXPECT_EQ(a.mass.table, b.mass.table);
  EXPECT_EQ(a.mass.total_kg, b.mass.total_kg);
  EXPECT_EQ(a.mass.segment_kg, b.mass.segment_kg);
  EXPECT_EQ(a.has_limits, b.has_limits);
  ASSERT_EQ(b.limits.size(), 1U);
  EXPECT_EQ(a.limits[0].bone, b.limits[0].bone);
  EXPECT_EQ(a.limits[0].min_rad, b.limits[0].min_rad);
  EXPECT_EQ(a.limits[0].max_rad, b.limits[0].max_rad);
  EXPECT_EQ(a.flexibility.min_trunk_thigh_angle_rad,
            b.flexibility.min_trunk_thigh_angle_rad);
  EXPECT_EQ(a.flexibility.straight_knee_rad, b.flexibility.straight_knee_rad);
  ASSERT_EQ(b.loads.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.loads[i].name, b.loads[i].name);
    EXPECT_EQ(a.loads[i].point.segment, b.loads[i].point.segment);
    EXPECT_EQ(a.loads[i].point.offset_in_t_pose, b.loads[i].point.offset_in_t_pose);
    EXPECT_EQ(a.loads[i].mass_kg, b.loads[i].mass_kg);
  }
}

// The first writing rounds an angle that is no exact number of degrees, the next do not.
TEST(CharacterFile, SettlesAnglesOnTheFirstWriting) {
  CharacterSpec spec = a_character();
  spec.traits.flexibility = {1.234567890123456, 0.17};
  const std::string once = character_spec_text(spec);
  const CharacterSpec read = parsed(once);
  EXPECT_NEAR(
      read.traits.flexibility.min_trunk_thigh_angle_rad, 1.234567890123456, 1e-15);
  EXPECT_EQ(character_spec_text(parsed(character_spec_text(read))),
            character_spec_text(read));
}

TEST(CharacterFile, IsBriefForAnAverageBody) {
  const CharacterSpec spec = parsed("format = 1\nname = \"Bob\"\nstature_m = 1.8\n");
  EXPECT_EQ(std::get<AverageBody>(spec.body).stature_m, 1.8);
  EXPECT_FALSE(spec.traits.mass.total_kg);
  EXPECT_TRUE(spec.traits.has_limits);
  EXPECT_EQ(spec.traits.flexibility.min_trunk_thigh_angle_rad, 0.0);
}

TEST(CharacterFile, ResolvesBodyPathsAgainstItsFolder) {
  const ScratchFolder folder;
  CharacterSpec spec = a_character();
  spec.body = SubjectBody{"../ann/subject.toml"};
  ASSERT_TRUE(write_character_spec(folder / "c.toml", spec));
  const auto read = read_character_spec(folder / "c.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<SubjectBody>(read->body).path,
            (folder / "../ann/subject.toml").lexically_normal().string());
}

TEST(CharacterFile, NamesTheNearestKey) {
  EXPECT_EQ(mistake("mass_kg = 61.5", "mas_kg = 61.5"),
            "c.toml:4: unknown key \"mas_kg\". Next: perhaps you mean \"mass_kg\".");
  EXPECT_TRUE(
      says(mistake("leftFoot = 0.4", "leftFeet = 0.4"),
           "unknown key \"leftFeet\" in [segment_mass_kg]. Next: perhaps you mean "
           "\"leftFoot\""));
  EXPECT_TRUE(says(mistake("[limits.leftLowerLeg]", "[limits.leftlowerleg]"),
                   "perhaps you mean \"leftLowerLeg\""));
  EXPECT_TRUE(says(mistake("\"deleva-female\"", "\"deleva-femal\""),
                   "unknown table \"deleva-femal\". Next: perhaps you mean "
                   "\"deleva-female\""));
  EXPECT_TRUE(says(mistake("least_trunk_thigh_deg", "trunk_thigh_deg"), "[flexibility]"));
  EXPECT_TRUE(says(mistake("offset_m", "offset"), "[[load]]"));
}

TEST(CharacterFile, WantsALoadNearItsBone) {
  const std::string given = "offset_m = [";
  EXPECT_TRUE(says(mistake(given, given + "1e300, 0.0, 0.0]\n#"),
                   "\"offset_m\" is beyond 10 km. Next: give metres from the segment's "
                   "joint"));
}

TEST(CharacterFile, WantsOneBody) {
  EXPECT_TRUE(says(mistake("avatar = \"../avatars/ann.vrm\"\n", ""),
                   "does not state whose lengths"));
  EXPECT_TRUE(says(mistake("avatar =", "stature_m = 1.7\navatar ="),
                   "\"stature_m\" is given together with \"avatar\""));
  EXPECT_TRUE(says(mistake("\"../avatars/ann.vrm\"", "\"\""), "the path is empty"));
}

TEST(CharacterFile, RefusesMassesOutsideTheirRange) {
  EXPECT_TRUE(says(mistake("mass_kg = 61.5", "mass_kg = 0"),
                   "c.toml:4: \"mass_kg\" is 0, not between 0.01 and 1000 kg"));
  EXPECT_TRUE(says(mistake("leftFoot = 0.4", "leftFoot = -0.4"), "\"leftFoot\" is -0.4"));
  EXPECT_TRUE(says(mistake("mass_kg = 5.0", "mass_kg = nan"), "must be a number"));
}

TEST(CharacterFile, RefusesLimitsTheWrongWayRound) {
  EXPECT_TRUE(says(mistake("[95.0", "[-95.0"), "about X \"min_deg\" is above"));
  EXPECT_TRUE(says(mistake("[95.0", "[950.0"), "\"max_deg\" is beyond half a turn"));
  EXPECT_TRUE(says(mistake("max_deg = ", "most_deg = "), "unknown key \"most_deg\""));
  EXPECT_TRUE(says(mistake("least_trunk_thigh_deg = 80.0", "least_trunk_thigh_deg = 200"),
                   "not between 0 and 180 degrees"));
}

TEST(CharacterFile, RefusesLoadsWithoutAUniqueNameOrASegment) {
  const std::string twice =
      documented() + "[[load]]\nname = \"bag\"\nsegment = \"head\"\nmass_kg = 1\n";
  const auto spec = parse_character_spec(twice, "c.toml");
  ASSERT_FALSE(spec);
  EXPECT_TRUE(says(spec.error().message(), "another load has this name"));
  EXPECT_TRUE(says(mistake("\"bag\"", "\"\""), "the name is empty"));
  EXPECT_TRUE(says(mistake("segment = \"leftHand\"", "segment = \"\""), "empty"));
}

TEST(CharacterFile, RefusesTextThatIsNotToml) {
  const auto spec = parse_character_spec("name = \n", "c.toml");
  ASSERT_FALSE(spec);
  EXPECT_TRUE(says(spec.error().message(), "c.toml:1: not valid TOML"));
}

}  // namespace
}  // namespace marey::recordings
