// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_run.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "live/page/page_scene.h"

namespace marey::live {
namespace {

using RunJson = nlohmann::json;

TEST(PageRun, ReportsStateAndFigures) {
  PageRun run;
  run.state = PageRunState::kPaused;
  run.time_s = 1.5;
  run.duration_s = 12.0;
  run.figures = {{"wrist_error", "mm", 0.25, "at most 1", true},
                 {"feet_slide", "mm", {}, "at most 0.1", {}}};
  run.messages = {"slow"};
  EXPECT_EQ(RunJson::parse(run_json(run)), RunJson::parse(R"({
    "type": "run", "state": "paused", "time_s": 1.5, "duration_s": 12.0,
    "figures": [
      {"name": "wrist_error", "unit": "mm", "value": 0.25, "bound": "at most 1",
       "passed": true},
      {"name": "feet_slide", "unit": "mm", "value": null, "bound": "at most 0.1",
       "passed": null}],
    "messages": ["slow"]})"));
}

TEST(PageRun, ReportsTargetsInOrder) {
  const std::vector<PageTarget> targets{{{1.0, 2.0, 3.0}, true},
                                        {{0.0, 0.5, 0.0}, false}};
  EXPECT_EQ(targets_json(targets),
            R"({"type":"targets","p_in_world":[[1.0,2.0,3.0],[0.0,0.5,0.0]],)"
            R"("held":[true,false]})");
}

TEST(PageRun, WritesValuesThatAreNotFiniteAsNull) {
  PageRun run;
  run.figures = {{"jerk_ratio", "", std::numeric_limits<double>::quiet_NaN(), "", {}}};
  EXPECT_TRUE(RunJson::parse(run_json(run))["figures"][0]["value"].is_null());
}

TEST(PageRun, MarksItsScenes) {
  PageScene scene;
  EXPECT_FALSE(RunJson::parse(scene_json(scene)).contains("run"));
  scene.run = true;
  const RunJson message = RunJson::parse(scene_json(scene));
  EXPECT_EQ(message["run"], true);
  EXPECT_EQ(message["mode"], "live");
}

}  // namespace
}  // namespace marey::live
