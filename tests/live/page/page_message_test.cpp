// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "live/page/page_scene.h"
#include "live/page/page_status.h"
#include "live/page/page_wizard.h"

namespace marey::live {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> out;
  for (const auto& [key, value] : object.items()) out.push_back(key);
  return out;
}

using Keys = std::vector<std::string>;

PageScene full_scene() {
  PageScene scene;
  scene.title = "walk";
  PageSkeleton body{.name = "performer", .kind = PageSkeletonKind::kPerformer};
  body.skeleton = make_humanoid(average_proportions(1.75));
  body.skin =
      PageSkin{"/media/1", "glb", {"mixamorig:Hips"}, {4}, 100.0, {1.0, 0.0, 0.0, 0.0}};
  body.offset_m = {1.5, 0.0, 0.0};
  body.estimate = true;
  scene.skeletons.push_back(body);
  PageCamera camera;
  camera.camera.name = "left";
  camera.camera.intrinsics.width_px = 640;
  camera.camera.camera_from_world.translation = {0.0, 0.0, 3.0};
  scene.cameras.push_back(camera);
  scene.point_labels = {"LASI"};
  scene.constraints.push_back({.id = "left hand", .draggable = true});
  PageFile file;
  file.frames = 3;
  file.block = "/media/2";
  file.tracks = {{"hips", {{{0, 2}, Source::kInferred}}}};
  file.contacts = {{"left heel", {{1, 2}}}};
  file.graphs = {{"reprojection", "px", {0.5, std::nan(""), 1.0}}};
  file.notes = {{1, "a note"}};
  file.trial = "walk";
  file.trials = {"walk", "jump"};
  file.report = "/report.html";
  scene.file = file;
  scene.wizard = PageWizard{};
  return scene;
}

TEST(PageScene, HasTheMembersOfTheProtocol) {
  const Json scene = Json::parse(scene_json(full_scene()));
  EXPECT_EQ(keys(scene),
            (Keys{"type",
                  "version",
                  "revision",
                  "title",
                  "mode",
                  "rate_hz",
                  "skeletons",
                  "cameras",
                  "points",
                  "floor",
                  "constraints",
                  "file",
                  "wizard"}));
  EXPECT_EQ(scene["type"], "scene");
  EXPECT_EQ(scene["mode"], "file");
  const Json& body = scene["skeletons"][0];
  EXPECT_EQ(keys(body), (Keys{"name", "kind", "joints", "skin", "offset_m", "estimate"}));
  EXPECT_EQ(body["kind"], "performer");
  EXPECT_EQ(body["offset_m"], Json::parse("[1.5,0.0,0.0]"));
  EXPECT_EQ(body["joints"].size(), 22U);
  EXPECT_EQ(keys(body["joints"][0]), (Keys{"name", "parent", "bone", "rest"}));
  EXPECT_EQ(body["joints"][0]["parent"], -1);
  EXPECT_EQ(body["joints"][1]["parent"], 0);
  EXPECT_EQ(body["joints"][1]["bone"], "spine");
  EXPECT_EQ(body["joints"][0]["rest"]["q"], Json::parse("[0.0,0.0,0.0,1.0]"));
  EXPECT_EQ(body["skin"],
            Json::parse(R"({"media":"/media/1","format":"glb","nodes":["mixamorig:Hips"],
                            "node_index":[4],"unit_from_m":100.0,
                            "scene_from_file":[0.0,0.0,0.0,1.0]})"));
}

TEST(PageScene, DescribesCameraPoses) {
  const Json camera = Json::parse(scene_json(full_scene()))["cameras"][0];
  EXPECT_EQ(keys(camera),
            (Keys{"name",
                  "width_px",
                  "height_px",
                  "fx",
                  "fy",
                  "cx",
                  "cy",
                  "world_from_camera",
                  "rms_px"}));
  EXPECT_EQ(camera["world_from_camera"]["p"][2], -3.0);
  EXPECT_TRUE(camera["rms_px"].is_null());
}

TEST(PageScene, DescribesARecording) {
  const Json scene = Json::parse(scene_json(full_scene()));
  EXPECT_EQ(scene["file"], Json::parse(R"({"frames":3,"first_frame":0,"block":"/media/2",
                "points_block":null,"tracks":[{"name":"hips","gaps":[[0,2,"inferred"]]}],
                "contacts":[{"name":"left heel","spans":[[1,2]]}],
                "graphs":[{"name":"reprojection","unit":"px","values":[0.5,null,1.0]}],
                "notes":[{"frame":1,"text":"a note"}],
                "trial":"walk","trials":["walk","jump"],"report":"/report.html"})"));
  EXPECT_EQ(scene["points"], Json::parse(R"({"labels":["LASI"]})"));
  EXPECT_EQ(scene["floor"], Json::parse(R"({"height_m":0.0})"));
  EXPECT_EQ(scene["constraints"],
            Json::parse(R"([{"id":"left hand","skeleton":0,"kind":"position",
                "active":true,"p_in_world":[0.0,0.0,0.0],"draggable":true}])"));
}

TEST(PageScene, KeepsEveryMemberWhenEmpty) {
  const Json scene = Json::parse(scene_json({}));
  EXPECT_EQ(scene["mode"], "live");
  for (const char* name : {"points", "file", "wizard"}) {
    EXPECT_TRUE(scene[name].is_null()) << name;
  }
  for (const char* name : {"skeletons", "cameras", "constraints"}) {
    EXPECT_EQ(scene[name], Json::array()) << name;
  }
}

TEST(PageScene, ReplacesBytesThatAreNoText) {
  PageScene scene;
  scene.title = "a\xff";
  EXPECT_EQ(Json::parse(scene_json(scene))["title"], "a\xef\xbf\xbd");
}

TEST(PageConstraints, AreAMessageOfTheirOwn) {
  const Json message = Json::parse(constraints_json(full_scene().constraints));
  EXPECT_EQ(keys(message), (Keys{"type", "constraints"}));
  EXPECT_EQ(message["type"], "constraints");
  EXPECT_EQ(message["constraints"].size(), 1U);
}

TEST(PageStatus, HasTheMembersOfTheProtocol) {
  PageStatus status;
  status.stages.push_back({"detect cam0", {1.0, 2.0}});
  status.cameras.push_back({.name = "left"});
  status.outputs.push_back({.name = "VMC"});
  const Json empty = Json::parse(status_json(status));
  EXPECT_EQ(keys(empty),
            (Keys{"type",
                  "clock_s",
                  "subject",
                  "warnings",
                  "frame",
                  "rate_hz",
                  "latency_ms",
                  "stages",
                  "overload",
                  "cameras",
                  "outputs",
                  "recording",
                  "clients",
                  "messages"}));
  EXPECT_EQ(empty["subject"], "waiting");
  for (const auto& [subject, word] : {std::pair{PageSubject::kTracked, "tracked"},
                                      std::pair{PageSubject::kPartly, "partly"},
                                      std::pair{PageSubject::kBehind, "behind"},
                                      std::pair{PageSubject::kStopped, "stopped"},
                                      std::pair{PageSubject::kLost, "lost"}}) {
    PageStatus changed;
    changed.subject = subject;
    changed.warnings = {"leftFoot has not been seen"};
    EXPECT_EQ(Json::parse(status_json(changed))["subject"], word);
    EXPECT_EQ(Json::parse(status_json(changed))["warnings"][0], changed.warnings[0]);
  }
  EXPECT_EQ(empty["stages"][0],
            Json::parse(R"({"name":"detect cam0","p50_ms":1.0,"p95_ms":2.0})"));
  EXPECT_EQ(keys(empty["cameras"][0]),
            (Keys{"name", "state", "frames", "dropped", "tags", "detail"}));
  EXPECT_EQ(keys(empty["outputs"][0]), (Keys{"name", "sent", "failed", "detail"}));
  EXPECT_TRUE(empty["recording"].is_null());
  status.recording = PageRecording{"take.sqlite", 12.0, ""};
  EXPECT_EQ(Json::parse(status_json(status))["recording"],
            Json::parse(R"({"file":"take.sqlite","seconds":12.0,"trouble":""})"));
}

TEST(PageWizard, ReportsTheCoverageOfEachPicture) {
  PageWizard wizard;
  wizard.step = WizardStep::kMove;
  wizard.quality.push_back(
      {Severity::kNote, "subject", "left forearm", "24.1 cm ± 0.3", ""});
  WizardCamera camera{.name = "left"};
  for (std::size_t i = 0; i < 12; ++i) camera.grid[i] = 0.5;
  wizard.cameras.push_back(camera);
  const Json message = Json::parse(wizard_json(wizard));
  EXPECT_EQ(
      keys(message),
      (Keys{"type", "step", "title", "text", "progress", "cameras", "quality", "error"}));
  EXPECT_EQ(message["step"], "move");
  EXPECT_EQ(message["cameras"][0]["coverage"], 0.25);
  EXPECT_EQ(message["cameras"][0]["grid"].size(), 48U);
  EXPECT_EQ(keys(message["quality"][0]), (Keys{"name", "value", "good"}));
}

TEST(PageError, ReportsTheCauseAndTheSubject) {
  EXPECT_EQ(error_json("id is missing"), R"({"type":"error","text":"id is missing"})");
  EXPECT_EQ(error_json("too early", "wizard"),
            R"({"type":"error","text":"too early","about":"wizard"})");
}

}  // namespace
}  // namespace marey::live
