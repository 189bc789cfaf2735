// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Bodies and actions that depend on each other, and files of another kind.
#include <string>

#include <gtest/gtest.h>

#include "recordings/body/floor_file.h"
#include "recordings/scene/read_scene.h"
#include "recordings/scene/read_trials.h"

namespace marey::recordings {
namespace {

const std::string kHead =
    "format = 1\nname = \"s\"\nduration_s = 10\nbase = \"m\"\n"
    "[[body]]\nid = \"a\"\n[[body]]\nid = \"b\"\n[[group]]\nid = \"g\"\ncount = 3\n";

std::string target_on(const std::string& body, const std::string& more = "") {
  return "[[target]]\nid = \"on." + body + "\"\npath = \"body\"\nbody = \"" + body +
         "\"\nsegment = \"leftHand\"\n" + more;
}

std::string follow(const std::string& body,
                   const std::string& target,
                   const std::string& time) {
  return "[[at]]\n" + time + "\nbody = \"" + body +
         "\"\ndo = \"follow\"\nsegment = \"head\"\ntarget = \"on." + target + "\"\n";
}

std::string cause_of(const std::string& text) {
  const Result<Scene> scene = parse_scene(text, "s.toml");
  return scene ? "" : scene.error().cause;
}

constexpr const char* kAtOnce = "bodies depend on each other in the same step, at ";

TEST(SceneDependencies, ACycleInAStepIsRefusedWithTheCycle) {
  const std::string targets = target_on("a") + target_on("b") + target_on("g.2");
  EXPECT_EQ(cause_of(kHead + targets + follow("a", "b", "time_s = 1\nfor_s = 2") +
                     follow("b", "a", "time_s = 2.5\nfor_s = 2")),
            std::string(kAtOnce) + "2.5 s: a on b on a");
  EXPECT_EQ(cause_of(kHead + targets + follow("a", "b", "time_s = 0") +
                     follow("b", "g.2", "time_s = 1") + follow("g", "a", "time_s = 2")),
            std::string(kAtOnce) + "2 s: a on b on g.2 on a");
  EXPECT_EQ(cause_of(kHead + targets + follow("a", "a", "time_s = 1")),
            std::string(kAtOnce) + "1 s: a on a");
  const Result<Scene> scene = parse_scene(
      kHead + targets + follow("a", "b", "time_s = 0") + follow("b", "a", "time_s = 1"),
      "s.toml");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().where, "s.toml:33");
  EXPECT_EQ(scene.error().next,
            "end one action with for_s or a stop before the other starts, or write "
            "last_step = true in one target");
}

TEST(SceneDependencies, OneAfterTheOtherIsAllowed) {
  const std::string targets = target_on("a") + target_on("b");
  EXPECT_EQ(cause_of(kHead + targets + follow("a", "b", "time_s = 1\nfor_s = 1") +
                     follow("b", "a", "time_s = 2.31")),
            "");
  // The fade of 0.3 s counts.
  EXPECT_NE(cause_of(kHead + targets + follow("a", "b", "time_s = 1\nfor_s = 1") +
                     follow("b", "a", "time_s = 2.29")),
            "");
  EXPECT_EQ(cause_of(kHead + targets + follow("a", "b", "time_s = 1\nid = \"x\"") +
                     "[[at]]\ntime_s = 3\nbody = \"a\"\ndo = \"stop\"\naction = \"x\"\n" +
                     follow("b", "a", "time_s = 4")),
            "");
  EXPECT_EQ(cause_of(kHead + target_on("a", "last_step = true\n") + target_on("b") +
                     follow("a", "b", "time_s = 1") + follow("b", "a", "time_s = 1")),
            "");
}

TEST(SceneDependencies, ActionsCannotWaitForEachOther) {
  const auto waits = [](const std::string& id, const std::string& after) {
    return "[[at]]\nid = \"" + id + "\"\nafter = \"" + after +
           "\"\nevent = \"e\"\nbody = \"a\"\ndo = \"play\"\nclip = \"c\"\n";
  };
  EXPECT_EQ(cause_of(kHead + waits("x", "y") + waits("y", "z") + waits("z", "x")),
            "actions wait for each other: \"x\" after \"y\" after \"z\" after \"x\"");
  EXPECT_EQ(cause_of(kHead + waits("x", "x")),
            "actions wait for each other: \"x\" after \"x\"");
}

TEST(SceneDependencies, ThousandsOfBodiesAreBounded) {
  std::string text = "format = 1\nname = \"s\"\nduration_s = 10\nbase = \"m\"\n";
  for (int k = 0; k < 6; ++k) {
    text += "[[group]]\nid = \"g" + std::to_string(k) + "\"\ncount = 1000\n";
    if (k == 4) {
      EXPECT_EQ(cause_of(text), "");
    }
  }
  EXPECT_EQ(cause_of(text), "the scene has more than 5000 bodies");
  std::string many = kHead;
  for (int k = 0; k < 2001; ++k) {
    many += "[[at]]\ntime_s = 0\nbody = \"a\"\ndo = \"stop\"\n";
  }
  EXPECT_EQ(cause_of(many), "it has 2001 tables of \"at\", more than 2000");
  EXPECT_EQ(cause_of(std::string(std::size_t{5} << 20, '\n')),
            "the scene is larger than 4 MiB");
}

TEST(SceneDependencies, AFileOfAnotherKindIsNamed) {
  EXPECT_EQ(cause_of(""), "the file is empty");
  EXPECT_EQ(cause_of("format = 1\nbase_m = 0.5\n"), "this is a floor, not a scene");
  EXPECT_EQ(cause_of("format = 1\nseed = 1\n[[throw]]\n"),
            "this is a list of trials, not a scene");
  EXPECT_EQ(cause_of("HIERARCHY\nROOT a\n"), "this is a BVH motion, not a TOML file");
  EXPECT_EQ(parse_trials(kHead, "t.toml").error().cause,
            "this is a scene, not a list of trials");
  EXPECT_EQ(parse_floor(kHead, "f.toml").error().cause, "this is a scene, not a floor");
  EXPECT_EQ(cause_of("format = 1\nname = \"s\"\nduration_s = 1\nbase = \"m\"\n"),
            "the scene has no body");
}

}  // namespace
}  // namespace marey::recordings
