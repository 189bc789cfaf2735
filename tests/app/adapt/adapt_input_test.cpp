// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs that `marey adapt` refuses, and its error messages.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/motion/bvh.h"
#include "tests/app/adapt/adapt_scene.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Expects the exit code, one error line with all of `parts`, and no output file.
void expect_refused(const AdaptScene& scene,
                    const std::vector<std::string>& more,
                    const std::vector<std::string>& parts,
                    int exit_code = 3) {
  fs::remove(scene / "out.bvh");
  const ProgramRun run = scene.adapt(more);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err.rfind("error: ", 0), 0U) << run.err;
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
  for (const std::string& part : parts) {
    EXPECT_NE(run.err.find(part), std::string::npos) << part << " in " << run.err;
  }
  EXPECT_FALSE(fs::exists(scene / "out.bvh"));
}

void expect_refused_set(const AdaptScene& scene,
                        const std::string& elements,
                        std::vector<std::string> parts) {
  parts.emplace_back("c.xml");
  expect_refused(scene, {"--constraints", scene.constraints(elements)}, parts);
}

std::string chained(const std::string& name,
                    const std::string& segment,
                    const std::string& other) {
  return "<ConstraintDistance><name>" + name + "</name><bodyPoint><segment>" + segment +
         "</segment></bodyPoint><specif><distance>0.1</distance><constraint>" + other +
         "</constraint></specif></ConstraintDistance>";
}

TEST(AdaptRefuses, FilesThatAreNotThere) {
  const AdaptScene scene;
  expect_refused(scene, {"--constraints", (scene / "no.xml").string()}, {"no.xml"});
  expect_refused(scene, {"--character", (scene / "no.toml").string()}, {"no.toml"});
  expect_refused(scene, {"--out", (scene / "out.fbx").string()}, {"out.fbx", ".bvh"});
  fs::remove(scene / "walk.bvh");
  expect_refused(scene, {}, {"walk.bvh"});
}

TEST(AdaptRefuses, BrokenConstraintsWithTheirLine) {
  const AdaptScene scene;
  expect_refused(scene,
                 {"--constraints",
                  scene.file("c.xml", "<ConstraintsSet>\n<Distance>\n<name>a</nome>\n")},
                 {"c.xml:3"});
  expect_refused_set(scene, hand_at({0, 1, 0}, "<priority>nan</priority>"), {":2"});
  expect_refused_set(scene, hand_at({0, 1, 0}, "<priority>0</priority>"), {"priority"});
}

TEST(AdaptRefuses, ConstraintsThatTheBodyCannotHave) {
  const AdaptScene scene;
  expect_refused_set(scene,
                     hand_at({0, 1, 0}, "", "leftHnad"),
                     {"\"hand\"", "leftHnad", "perhaps you mean \"leftHand\""});
  expect_refused_set(scene,
                     chained("a", "leftHand", "b") + chained("b", "rightHand", "a"),
                     {"cycle", "\"a\"", "\"b\""});
  expect_refused_set(
      scene,
      "<Support><name>handstand</name><bodyPoint><segment>leftHand</segment></bodyPoint>"
      "</Support>",
      {"\"handstand\"", "\"leftHand\""});
}

TEST(AdaptRefuses, CharactersWithoutMassOrLoadOrGroup) {
  const AdaptScene scene;
  const auto who = [&](const std::string& more) {
    return scene.file("c.toml", "format = 1\nname = \"Ann\"\nstature_m = 1.7\n" + more);
  };
  expect_refused(scene, {"--character", who("mass_kg = 0.0\n")}, {"c.toml:4", "mass_kg"});
  const std::string bag =
      who("[[load]]\nname = \"rucksack\"\nsegment = \"leftHand\"\nmass_kg = 5.0\n");
  expect_refused(scene,
                 {"--character", bag, "--load", "rucksak"},
                 {"c.toml", "\"rucksak\"", "perhaps you mean \"rucksack\""});
  expect_refused(scene, {"--load", "bag"}, {"\"bag\"", "[[load]]"});
  expect_refused(scene,
                 {"--balance-groups", "left arn"},
                 {"\"left arn\"", "perhaps you mean \"left arm\""},
                 2);
}

// The program protects an input under every name of its file.
TEST(AdaptRefuses, ToOverwriteItsInput) {
  const AdaptScene scene;
  ASSERT_TRUE(recordings::write_bvh(scene / "body.bvh", scene.walk().motion));
  const std::string who = scene.file(
      "c.toml", "format = 1\nname = \"Ann\"\navatar = \"body.bvh\"\nmass_kg = 70.0\n");
  fs::create_hard_link(scene / "walk.bvh", scene / "same.bvh");
  const auto expect_kept = [&](const std::string& name, const std::string& role) {
    const std::string before = *recordings::read_file(scene / name);
    const std::string out = (scene / name).string();
    expect_refused(
        scene, {"--character", who, "--out", out}, {out, role, "another name"});
    EXPECT_EQ(*recordings::read_file(scene / name), before) << name;
  };
  expect_kept("walk.bvh", "the motion to adapt");
  expect_kept("same.bvh", "the motion to adapt");
  expect_kept("body.bvh", "the character's body");
}

// A body that has no leg to stand on.
TEST(AdaptRefuses, AMotionWithoutLegs) {
  const AdaptScene scene;
  Motion motion = scene.walk().motion;
  const auto knee = *motion.skeleton.find(HumanBone::kLeftLowerLeg);
  motion.skeleton = testing::without(motion.skeleton, HumanBone::kLeftLowerLeg);
  for (Pose& pose : motion.poses) {
    pose.parent_from_joint.erase(pose.parent_from_joint.begin() +
                                 static_cast<std::ptrdiff_t>(index(knee)));
  }
  ASSERT_TRUE(recordings::write_bvh(scene / "walk.bvh", motion));
  expect_refused(scene, {}, {"walk.bvh", "leftLowerLeg"});
}

TEST(AdaptRefuses, InvalidFloors) {
  const AdaptScene scene;
  expect_refused(scene, {"--floor", (scene / "no.toml").string()}, {"no.toml"});
  const std::string bad =
      scene.file("floor.toml", "format = 1\n[[part]]\nname = \"a\"\nx_m = [1, 0]\n");
  expect_refused(scene, {"--floor", bad}, {"floor.toml:4", "x_m"});
  expect_refused(scene,
                 {"--floor", scene.file("f.toml", "format = 1\n"), "--supports", "none"},
                 {"--floor", "--supports auto"});
}

TEST(AdaptRefuses, OptionsOutOfRange) {
  const AdaptScene scene;
  for (const std::vector<std::string>& bad :
       std::vector<std::vector<std::string>>{{"--root-share", "1.5"},
                                             {"--root-share", "nan"},
                                             {"--method", "magic"},
                                             {"--max-iterations", "0"},
                                             {"--floor-height", "nan"}}) {
    EXPECT_EQ(scene.adapt(bad).exit_code, 2) << bad[0];
  }
  EXPECT_FALSE(fs::exists(scene / "out.bvh"));
}

}  // namespace
}  // namespace marey::testing
