// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "recordings/scene/read_scene.h"

namespace marey::recordings {
namespace {

/// A replacement in the sound scene, and the message about it.
struct SceneFault {
  const char* from;
  const char* to;
  int line;
  const char* cause;
  const char* next;
};

constexpr const char* kSound = R"(format = 1
name = "sound"
seed = 3
step_hz = 60.0
duration_s = 10.0
base = "moves.marey"
gravity_m_s2 = 9.81
[[body]]
id = "ann"
stature_m = 1.7
importance = 2.0
[[group]]
id = "crowd"
count = 3
stature_m = [1.5, 1.9]
[[target]]
id = "cup"
path = "fixed"
position_m = [0.0, 1.0, 1.0]
[[target]]
id = "wrist"
path = "body"
body = "crowd"
segment = "leftHand"
[[target]]
id = "route"
path = "polyline"
times_s = [0.0, 4.0]
positions_m = [[0, 0, 0], [1, 0, 0]]
[[at]]
id = "walk"
time_s = 0.0
body = "ann"
do = "play"
clip = "walk"
loops = true
[[at]]
id = "end"
time_s = 4.0
body = "ann"
do = "stop"
action = "walk"
[[at]]
after = "walk"
body = "ann"
do = "reach"
clip = "reach"
target = "cup"
[[at]]
time_s = 1.0
for_s = 2.0
body = "crowd"
do = "follow"
segment = "rightHand"
target = "cup"
[[out.vmc]]
body = "ann"
port = 39539
[[measure]]
kind = "feet_slide"
body = "crowd.2"
max_mm = 0.1
)";

constexpr const char* kAsThePageShows = "write it as docs/formats/scene.md shows";
constexpr const char* kAddAsThePage = "add it; docs/formats/scene.md describes it";

void expect_refused(const SceneFault& fault) {
  std::string text = kSound;
  const std::size_t at = text.find(fault.from);
  ASSERT_NE(at, std::string::npos) << fault.from;
  text.replace(at, std::string(fault.from).size(), fault.to);
  const Result<Scene> scene = parse_scene(text, "s.toml");
  ASSERT_FALSE(scene) << fault.to;
  const Error& error = scene.error();
  EXPECT_EQ(error.code, Errc::kBadInput);
  EXPECT_EQ(error.where, "s.toml:" + std::to_string(fault.line)) << error.message();
  EXPECT_EQ(error.cause, fault.cause) << fault.to;
  EXPECT_EQ(error.next, fault.next) << fault.to;
}

TEST(SceneRefusal, TheSoundSceneIsSound) {
  const Result<Scene> scene = parse_scene(kSound, "s.toml");
  ASSERT_TRUE(scene) << scene.error().message();
}

TEST(SceneRefusal, NamesTheMistakeInTheHead) {
  for (const SceneFault& fault : {
           SceneFault{"format = 1",
                      "format = 2",
                      1,
                      "the scene was made for a newer marey: its format is 2, and this "
                      "marey reads 1",
                      "update marey"},
           SceneFault{
               "format = 1", "format = 0", 1, "its format is 0", "write format = 1"},
           SceneFault{"\"sound\"",
                      "\"a/b\"",
                      2,
                      "\"a/b\" cannot be a part of a file name",
                      "write a name without slashes that does not begin with a dot"},
           SceneFault{"step_hz",
                      "step_hy",
                      4,
                      "unknown key \"step_hy\"",
                      "perhaps you mean \"step_hz\""},
           SceneFault{"step_hz = 60.0",
                      "step_hz = 0.0",
                      4,
                      "\"step_hz\" is 0, not between 1 and 1000 Hz",
                      "give it in Hz"},
           SceneFault{"duration_s = 10.0",
                      "duration_s = nan",
                      5,
                      "\"duration_s\" must be a number that is finite",
                      kAsThePageShows},
           SceneFault{"base = \"moves.marey\"\n",
                      "",
                      1,
                      "the key \"base\" is missing",
                      kAddAsThePage},
           SceneFault{"gravity_m_s2 = 9.81",
                      "cost_units = [2, 7, 7, 9]",
                      7,
                      "\"cost_units\" does not ascend",
                      "give the costs of the levels 0, 1, 2 and 3"},
       }) {
    expect_refused(fault);
  }
}

TEST(SceneRefusal, NamesTheMistakeInBodies) {
  for (const SceneFault& fault : {
           SceneFault{"importance",
                      "importence",
                      11,
                      "unknown key \"importence\" in [[body]]",
                      "perhaps you mean \"importance\""},
           SceneFault{"importance = 2.0",
                      "importance = -1.0",
                      11,
                      "\"importance\" is -1, not between 0 and 1e+06",
                      "correct the number"},
           SceneFault{"id = \"crowd\"",
                      "id = \"ann\"",
                      13,
                      "\"ann\" is used twice",
                      "give each an id of its own"},
           SceneFault{"id = \"ann\"",
                      "id = \"crowd.3\"",
                      13,
                      "\"crowd.3\" has the id of a member of this group",
                      "choose another id: members are named GROUP.NUMBER"},
           SceneFault{"id = \"ann\"",
                      "id = \"an n\"",
                      9,
                      "\"id\" has a letter that an id cannot have",
                      "use a to z, A to Z, digits, \"_\", \"-\" and \".\""},
           SceneFault{"importance = 2.0",
                      "file = \"a.vrm\"",
                      10,
                      "both \"file\" and \"stature_m\" are given",
                      "remove one: the file has the body's proportions and masses"},
           SceneFault{"[1.5, 1.9]",
                      "[1.9, 1.5]",
                      15,
                      "\"stature_m\" descends",
                      "give the smaller number first"},
           SceneFault{"count = 3",
                      "count = 0",
                      14,
                      "\"count\" is 0, not between 1 and 1000",
                      "correct the number"},
       }) {
    expect_refused(fault);
  }
}

TEST(SceneRefusal, NamesTheMistakeInTargets) {
  for (const SceneFault& fault : {
           SceneFault{"path = \"fixed\"",
                      "path = \"fix\"",
                      18,
                      "\"path\" cannot be \"fix\"",
                      "perhaps you mean \"fixed\""},
           SceneFault{"body = \"crowd\"\nsegment",
                      "body = \"crowds\"\nsegment",
                      23,
                      "there is no body or group \"crowds\"",
                      "perhaps you mean \"crowd\""},
           SceneFault{"body = \"crowd\"\nsegment",
                      "body = \"crowd.4\"\nsegment",
                      23,
                      "there is no body or group \"crowd.4\"",
                      "perhaps you mean \"crowd\""},
           SceneFault{"[0.0, 4.0]",
                      "[4.0, 4.0]",
                      28,
                      "\"times_s\" does not ascend",
                      "give each time once, in order"},
           SceneFault{"position_m = [0.0, 1.0, 1.0]",
                      "position_m = [0.0, 1.0, 1.0]\nfor_stature_m = 1.7",
                      20,
                      "\"for_stature_m\" needs positions in the frame of a body",
                      "add frame = \"body\", or remove it"},
           SceneFault{"position_m = [0.0, 1.0, 1.0]",
                      "middle_m = [0.0, 1.0, 1.0]",
                      19,
                      "unknown key \"middle_m\" in [[target]]",
                      "choose one of \"id\", \"path\", \"position_m\", \"frame\", "
                      "\"for_stature_m\", \"drag\""},
       }) {
    expect_refused(fault);
  }
}

TEST(SceneRefusal, NamesTheMistakeInTheScript) {
  for (const SceneFault& fault : {
           SceneFault{"do = \"reach\"",
                      "do = \"grab\"",
                      46,
                      "\"do\" cannot be \"grab\"",
                      "choose one of \"play\", \"stop\", \"reach\", \"throw\", "
                      "\"steer\", \"jump\", \"follow\", \"carry\", \"constrain\""},
           SceneFault{"target = \"cup\"",
                      "target = \"cap\"",
                      48,
                      "there is no target \"cap\"",
                      "perhaps you mean \"cup\""},
           SceneFault{"target = \"cup\"",
                      "target = \"wrist\"",
                      45,
                      "\"ann\" has 1 body, and the target \"wrist\" is on 3",
                      "name groups with equal counts, or one member of the other group"},
           SceneFault{"after = \"walk\"",
                      "after = \"wolk\"",
                      44,
                      "there is no action \"wolk\"",
                      "perhaps you mean \"walk\""},
           SceneFault{"after = \"walk\"\nbody = \"ann\"",
                      "after = \"walk\"\nbody = \"crowd\"",
                      44,
                      "\"walk\" is an action of other bodies",
                      "name an action of \"crowd\""},
           SceneFault{"loops = true",
                      "loops = true\ncycles = 3",
                      37,
                      "both \"loops\" and \"cycles\" are given",
                      "remove one: they exclude each other"},
           SceneFault{"loops = true",
                      "rate = 0.0",
                      36,
                      "\"rate\" is 0, not between 0.25 and 4",
                      "correct the number"},
           SceneFault{"loops = true",
                      "priority = -1.0",
                      36,
                      "\"priority\" is -1, not between 0 and 1e+06",
                      "correct the number"},
           SceneFault{"loops = true",
                      "priorities = {left_am = 1.0}",
                      36,
                      "unknown key \"left_am\" in priorities of [[at]]",
                      "perhaps you mean \"left_arm\""},
           SceneFault{"time_s = 4.0",
                      "time_s = 11.0",
                      39,
                      "the action starts after the scene's end",
                      "increase duration_s"},
           SceneFault{"after = \"walk\"",
                      "event = \"left.strike\"\ntime_s = 1.0",
                      44,
                      "\"event\" is given without \"after\"",
                      "add after, an action's id"},
       }) {
    expect_refused(fault);
  }
}

TEST(SceneRefusal, AnActionCannotWaitForOneWithoutAnEnd) {
  constexpr const char* kCause =
      "the action waits for the end of \"walk\", which has no end";
  constexpr const char* kNext =
      "give \"walk\" for_s, stop it, or wait for an event of it";
  for (const SceneFault& fault :
       {SceneFault{"action = \"walk\"", "action = \"end\"", 44, kCause, kNext},
        SceneFault{"time_s = 4.0", "after = \"walk\"", 39, kCause, kNext},
        SceneFault{"time_s = 4.0", "time_s = 0.0", 44, kCause, kNext},
        SceneFault{"body = \"ann\"\ndo = \"stop\"\naction = \"walk\"",
                   "body = \"ann\"\ndo = \"stop\"\nlayer = 1",
                   44,
                   kCause,
                   kNext}}) {
    expect_refused(fault);
  }
  for (const char* end : {"for_s = 3.0", "cycles = 3"}) {
    std::string text = kSound;
    text.replace(text.find("loops = true"), 12, end);
    text.replace(text.find("action = \"walk\""), 15, "action = \"end\"");
    const Result<Scene> scene = parse_scene(text, "s.toml");
    EXPECT_TRUE(scene) << scene.error().message();
  }
}

TEST(SceneRefusal, NamesTheMistakeInResults) {
  for (const SceneFault& fault : {
           SceneFault{"port = 39539",
                      "port = 0",
                      58,
                      "\"port\" is 0, not between 1 and 65535",
                      "correct the number"},
           SceneFault{"body = \"ann\"\nport",
                      "body = \"crowd\"\nport",
                      57,
                      "one port sends one body, and \"crowd\" is a group",
                      "name a member, as \"crowd.1\""},
           SceneFault{"max_mm = 0.1",
                      "max_m = 0.1",
                      62,
                      "unknown key \"max_m\" in [[measure]]",
                      "perhaps you mean \"max_mm\""},
           SceneFault{"feet_slide",
                      "foot_slide",
                      60,
                      "\"kind\" cannot be \"foot_slide\"",
                      "perhaps you mean \"feet_slide\""},
           SceneFault{"feet_slide",
                      "wrist_error",
                      59,
                      "the key \"segment\" is missing in [[measure]]",
                      kAddAsThePage},
           SceneFault{"body = \"crowd.2\"\n",
                      "",
                      59,
                      "the key \"body\" is missing in [[measure]]",
                      "add body, or bodies"},
       }) {
    expect_refused(fault);
  }
}

// The k-th body of a figure is measured with the k-th body of the target or action.
TEST(SceneRefusal, NamesFiguresWhoseBodiesHaveNoPartners) {
  const std::string head =
      "format = 1\nname = \"pairs\"\nduration_s = 3.0\nbase = \"moves.marey\"\n"
      "[[group]]\nid = \"red\"\ncount = 3\n[[group]]\nid = \"blue\"\ncount = 2\n"
      "[[target]]\nid = \"ankle\"\npath = \"body\"\nbody = \"blue\"\n"
      "segment = \"leftFoot\"\n"
      "[[at]]\nid = \"kick\"\ntime_s = 0.0\nbody = \"blue\"\ndo = \"play\"\n"
      "clip = \"kick\"\n[[measure]]\n";
  const std::string point = "segment = \"leftHand\"\ntarget = \"ankle\"\n";
  for (const std::string& figure :
       {"kind = \"clearance\"\nbody = \"red\"\n" + point,
        "kind = \"clearance\"\nbodies = [\"blue\", \"red.2\"]\n" + point,
        "kind = \"parry\"\nbody = \"red\"\naction = \"kick\"\nevent = \"impact\"\n" +
            point}) {
    const auto scene = parse_scene(head + figure, "pairs.toml");
    ASSERT_FALSE(scene) << figure;
    EXPECT_NE(scene.error().cause.find("is on 2"), std::string::npos)
        << scene.error().message();
  }
  EXPECT_TRUE(parse_scene(head + "kind = \"clearance\"\nbody = \"blue\"\n" + point,
                          "pairs.toml"));
}

}  // namespace
}  // namespace marey::recordings
