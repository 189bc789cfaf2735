// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "core/engine/scene_order.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/scene/read_deed.h"
#include "recordings/scene/read_trials.h"
#include "recordings/session/file_kind.h"
#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

std::filesystem::path sample_scenes() {
  return testing::source_dir() / "recordings/samples/scenes";
}

Scene sample_scene(const std::string& name) {
  const Result<Scene> scene = read_scene(sample_scenes() / (name + ".toml"));
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().message());
  return scene ? *scene : Scene{};
}

TEST(SceneSamples, AreReadAndNamedAfterTheirFiles) {
  for (const std::string name :
       {"forty", "karate", "moving_floor", "drunk", "goalkeeper"}) {
    const Scene scene = sample_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_EQ(scene.base, (sample_scenes() / "moves.marey").string());
    EXPECT_FALSE(scene.figures.empty());
    const Result<FileKind> kind = file_kind(sample_scenes() / (name + ".toml"));
    ASSERT_TRUE(kind);
    EXPECT_EQ(*kind, FileKind::kScene);
    if (!scene.floor.empty()) {
      EXPECT_TRUE(read_floor(scene.floor));
    }
  }
}

TEST(SceneSamples, FortyBodiesFollowFromTenLines) {
  const Scene scene = sample_scene("forty");
  const std::vector<SceneBody> bodies = scene_bodies(scene);
  ASSERT_EQ(bodies.size(), 40U);
  std::vector<double> statures_m;
  for (const SceneBody& body : bodies) {
    statures_m.push_back(std::get<SceneBuild>(body.source).stature_m);
  }
  EXPECT_DOUBLE_EQ(*std::min_element(statures_m.begin(), statures_m.end()), 0.6);
  EXPECT_DOUBLE_EQ(*std::max_element(statures_m.begin(), statures_m.end()), 2.5);
  EXPECT_TRUE(scene_dependencies(scene).empty());
}

TEST(SceneSamples, KarateNeverDependsInACircle) {
  const Scene scene = sample_scene("karate");
  const auto all = scene_dependencies(scene);
  EXPECT_EQ(all.size(), 16U);
  EXPECT_FALSE(find_cycle(all, body_count(scene)));
  const auto bodies = scene_bodies(scene);
  for (const SceneDependency& link : all) {
    EXPECT_NEAR(bodies[link.body].place_xz_m.x, bodies[link.on].place_xz_m.x, 1e-9);
  }
  std::vector<std::size_t> rounds;
  solve_rounds(all, 1.6, bodies.size(), rounds);
  EXPECT_EQ(rounds, (std::vector<std::size_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  solve_rounds(all, 6.7, bodies.size(), rounds);
  EXPECT_EQ(rounds, (std::vector<std::size_t>{1, 1, 1, 1, 0, 0, 0, 0}));
}

TEST(SceneSamples, TheStudyFitsItsScene) {
  const Scene scene = sample_scene("goalkeeper");
  const auto& deed = std::get<SceneThrow>(scene.script.at(0).deed);
  const Result<TrialList> list = read_trials(deed.trials);
  ASSERT_TRUE(list) << list.error().message();
  const std::vector<PlannedTrial> order = trial_order(*list);
  EXPECT_EQ(order.size(), 44U);
  const double end_s =
      scene.script[0].time_s + static_cast<double>(order.size()) * deed.every_s;
  EXPECT_LE(end_s, scene.duration_s);
}

TEST(ScenePage, ItsExampleIsRead) {
  const Result<Scene> scene = parse_scene(testing::formats_example("scene"), "page");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->script.size(), 3U);
  EXPECT_EQ(body_count(*scene), 5U);
  EXPECT_NEAR(scene->bodies[0].heading_rad, 90.0 * kRadiansPerDegree, 1e-15);
  EXPECT_EQ(scene->script[1].after, "walk");
}

TEST(ScenePage, NamesEveryDeedFigureAndKey) {
  const std::string page = testing::formats_page("scene");
  const auto expect_word = [&](const std::string& word) {
    EXPECT_NE(page.find("`" + word + "`"), std::string::npos) << word;
  };
  for (std::size_t deed = 0; deed < kSceneDeeds.size(); ++deed) {
    expect_word(std::string(kSceneDeeds[deed]));
    for (const std::string_view key : stage::deed_keys(deed)) {
      expect_word(std::string(key));
    }
  }
  for (const SceneFigureRule& rule : kSceneFigureRules) {
    expect_word(std::string(rule.word));
    const auto position = static_cast<std::size_t>(rule.kind);
    EXPECT_EQ(kSceneFigureRules[position].word, rule.word);
  }
}

TEST(SceneFile, ReadsEveryDeed) {
  const Result<Scene> scene = parse_scene(R"(format = 1
name = "all"
duration_s = 60
base = "m"
[[body]]
id = "a"
[[target]]
id = "t"
path = "fixed"
position_m = [0, 1, 1]
[[at]]
id = "walk"
time_s = 0
body = "a"
do = "play"
clip = "walk"
cycles = 3
rate = 1.5
transition = "inertial"
priorities = {left_arm = 0, root = 2.5}
[[at]]
after = "walk"
event = "left.strike"
body = "a"
do = "stop"
layer = 2
fade_out_s = 0.1
[[at]]
time_s = 1
body = "a"
do = "reach"
clip = "reach"
target = "t"
hand = "left"
approach = [0, 0, 2]
orientation_deg = [0, 90, 0]
arrival_speed_m_s = 0.25
holds = true
for_s = 4
[[at]]
time_s = 1
body = "a"
do = "throw"
clip = "punch"
speed_m_s = 20
aim = "t"
[[at]]
time_s = 1
body = "a"
do = "steer"
clip = "walk"
target = "t"
step_length = [0.5, 1.5]
[[at]]
time_s = 1
body = "a"
do = "jump"
clip = "jump"
apex_by_m = 0.2
target = "t"
[[at]]
time_s = 1
body = "a"
do = "follow"
target = "t"
segment = "leftHand"
[[at]]
time_s = 1
body = "a"
do = "carry"
mass_kg = 5
hand = "left"
layer = 3
[[at]]
time_s = 1
body = "a"
do = "constrain"
type = "oriented"
segment = "head"
orientation_wxyz = [1, 0, 0, 0]
)",
                                          "s.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->script.size(), kSceneDeeds.size());
  for (std::size_t k = 0; k < kSceneDeeds.size(); ++k) {
    EXPECT_EQ(scene->script[k].deed.index(), k);
  }
  const auto& play = std::get<ScenePlay>(scene->script[0].deed);
  EXPECT_EQ(play.cycles, 3);
  EXPECT_EQ(play.transition, SceneTransition::kInertial);
  EXPECT_EQ(scene->script[0].group_priority[0], 2.5);
  EXPECT_EQ(scene->script[0].group_priority[3], 0.0);
  EXPECT_FALSE(scene->script[0].group_priority[1]);
  EXPECT_EQ(std::get<SceneStop>(scene->script[1].deed).layer, 2);
  const auto& reach = std::get<SceneReach>(scene->script[2].deed);
  EXPECT_EQ(reach.approach_in_world, glm::dvec3(0.0, 0.0, 1.0));
  EXPECT_EQ(reach.hand, SceneHand::kLeft);
  EXPECT_NEAR(reach.world_from_t_pose->y, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(std::get<SceneCarry>(scene->script[7].deed).mass_kg, 5.0);
  EXPECT_EQ(scene->script[7].layer, 3);
}

}  // namespace
}  // namespace marey::recordings
