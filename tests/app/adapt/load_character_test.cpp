// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/load_character.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/character_file.h"
#include "recordings/session/subject_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using testing::ScratchFolder;

double total_kg(const Character& character) {
  double sum = 0.0;
  for (const PointMass& mass : character.masses) sum += mass.mass_kg;
  return sum;
}

std::string said(const std::filesystem::path& path) {
  const auto character = load_character(path);
  return character ? "" : character.error().message();
}

TEST(LoadCharacter, MakesAnAverageBody) {
  const ScratchFolder folder;
  CharacterSpec spec;
  spec.name = "Bob";
  spec.body = AverageBody{1.8};
  spec.traits.mass.total_kg = 80.0;
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  const auto character = load_character(folder / "c.toml");
  ASSERT_TRUE(character) << character.error().message();
  EXPECT_EQ(character->name, "Bob");
  EXPECT_EQ(character->groups.size(), 7U);
  EXPECT_NEAR(total_kg(*character), 80.0, 1e-9);
}

// The path of the subject is relative to the character's file. The character has the
// subject's mass, unless it has its own.
TEST(LoadCharacter, TakesTheLengthsAndTheMassOfASubject) {
  const ScratchFolder folder;
  Body body;
  body.name = "S16";
  body.stature_m = 1.62;
  body.mass_kg = 55.5;
  body.proportions = average_proportions(1.62);
  ASSERT_TRUE(recordings::write_subject(folder / "s.toml", body));
  CharacterSpec spec;
  spec.name = "Eve";
  spec.body = SubjectBody{"s.toml"};
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  const auto character = load_character(folder / "c.toml");
  ASSERT_TRUE(character) << character.error().message();
  EXPECT_NEAR(total_kg(*character), 55.5, 1e-9);
  EXPECT_EQ(character->skeleton[JointIndex{0}].parent_from_joint.translation,
            body.proportions[HumanBone::kHips]);
  spec.traits.mass.total_kg = 60.0;
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  EXPECT_NEAR(total_kg(*load_character(folder / "c.toml")), 60.0, 1e-9);
}

TEST(LoadCharacter, TakesTheSkeletonOfAnAvatar) {
  const std::filesystem::path avatar =
      marey::testing::shared_data() / "avatars/vrm/cryptovoxels.vrm";
  if (!std::filesystem::exists(avatar)) GTEST_SKIP() << "the avatars are missing";
  const ScratchFolder folder;
  CharacterSpec spec;
  spec.name = "Voxel";
  spec.body = AvatarBody{std::filesystem::absolute(avatar).string()};
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  const auto character = load_character(folder / "c.toml");
  ASSERT_TRUE(character) << character.error().message();
  EXPECT_EQ(character->groups.size(), 7U);
}

TEST(LoadCharacter, NamesTheFileThatIsToBlame) {
  const ScratchFolder folder;
  CharacterSpec spec;
  spec.name = "Eve";
  spec.body = AvatarBody{"nobody.vrm"};
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  EXPECT_NE(said(folder / "c.toml").find("nobody.vrm"), std::string::npos);
  spec.body = AverageBody{1.8};
  spec.traits.loads.push_back({"bag", {"leftHant", {}}, 5.0});
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  EXPECT_EQ(said(folder / "c.toml"),
            (folder / "c.toml").string() +
                ": load \"bag\": the skeleton has no segment \"leftHant\". Next: perhaps "
                "you mean \"leftHand\".");
  ASSERT_TRUE(
      recordings::write_file(folder / "stub.bvh",
                             "HIERARCHY\nROOT hips\n{\nOFFSET 0 1 0\nCHANNELS 3 "
                             "Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 "
                             "1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n0 0 "
                             "0\n"));
  spec.body = AvatarBody{"stub.bvh"};
  ASSERT_TRUE(recordings::write_character_spec(folder / "c.toml", spec));
  EXPECT_NE(said(folder / "c.toml")
                .find("stub.bvh: skeleton: no body was found among its 1 joints"),
            std::string::npos);
}

}  // namespace
}  // namespace marey::app
