// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey retarget` on bodies of many kinds. Code that shares nothing with the program
// judges the results (tests/support/truth/body_judge.h).
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/retarget_scene.h"
#include "tests/support/bodies/body_campaign.h"
#include "tests/support/bodies/made_body.h"
#include "tests/support/files/floor_clip.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Generated bodies, and the real ones where they are.
std::vector<CampaignBody> all_bodies(const fs::path& folder) {
  std::vector<CampaignBody> out = made_bodies(folder, 101, 10);
  const fs::path shared = marey::testing::shared_data() / "avatars";
  for (const char* name : {"makehuman/adult_female_game_engine.glb",
                           "makehuman/adult_male_mixamo_unity.glb",
                           "makehuman/giant_cmu_mb.glb",
                           "vrm/cryptovoxels.vrm"}) {
    if (!fs::exists(shared / name)) continue;
    const PosedGlb glb(shared / name);
    out.push_back({shared / name, bone_nodes(glb.node_names()), "real"});
  }
  return out;
}

void expect_no_gross_errors(const std::vector<CampaignResult>& results,
                            const std::vector<CampaignBody>& bodies) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_TRUE(results[i].judged) << results[i].body << ": " << results[i].error;
    for (const std::string& error : gross_errors(results[i])) {
      // Hair does not lift a body that lies on it; the report contains a problem instead.
      const bool is_hair = error == "skin in the floor" &&
                           results[i].judged->skin_node.starts_with("hair_");
      if (is_hair && !results[i].reported_problems.empty()) continue;
      ADD_FAILURE() << error << ": " << results[i].clip << " on " << results[i].body
                    << " (" << bodies[i].words << "), skin "
                    << results[i].judged->skin_depth_mm << " mm at frame "
                    << results[i].judged->skin_frame << " by "
                    << results[i].judged->skin_node << ", segment "
                    << results[i].judged->worst_segment << " "
                    << results[i].judged->worst_median_deg << " deg";
    }
  }
}

TEST(RetargetBodies, KeepTheirSkinAboveTheFloorAndThePosture) {
  const RetargetScene scene;
  const fs::path folder = scene / "bodies";
  fs::create_directories(folder);
  const auto bodies = all_bodies(folder);
  const fs::path floor = scene / "floor.bvh";
  write_floor_clip(floor);
  for (const fs::path& clip : {floor, scene / "walk.bvh"}) {
    expect_no_gross_errors(run_campaign(marey::testing::program(), folder, clip, bodies),
                           bodies);
  }
}

// Without the ground the skin is deep, so that the figure is one to compare.
TEST(RetargetBodies, MatchTheReportedSkinDepth) {
  const RetargetScene scene;
  const fs::path folder = scene / "bodies";
  fs::create_directories(folder);
  const auto bodies = all_bodies(folder);
  const fs::path floor = scene / "floor.bvh";
  write_floor_clip(floor);
  int deep = 0;
  for (const CampaignResult& result :
       run_campaign(marey::testing::program(), folder, floor, bodies, {"--no-ground"})) {
    ASSERT_TRUE(result.judged && result.reported_depth_mm) << result.error;
    EXPECT_NEAR(*result.reported_depth_mm,
                result.judged->skin_depth_mm,
                0.1 * result.judged->skin_depth_mm)
        << result.body;
    if (result.judged->skin_depth_mm > 20.0) ++deep;
  }
  EXPECT_GE(deep, 8);
}

// Ears do not lift the whole body. The error names the body, frame, depth and next step.
TEST(RetargetBodies, AreRefusedTheirBadgeWhereSkinStaysInTheFloor) {
  const RetargetScene scene;
  MadeBodyRule rule;
  rule.ears = true;
  const auto nodes = write_made_body(rule, scene / "hare.glb");
  write_floor_clip(scene / "floor.bvh");
  const ProgramRun run =
      scene.marey({"retarget", "floor.bvh", "hare.glb", "--out", "o.glb"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_TRUE(scene.has("o.glb"));
  for (const char* word :
       {"hare.glb, frame ", "hair or clothes", "mm below the floor", "Next: "}) {
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
  }
}

// A body whose map exchanges left and right walks backwards or is refused; never silent.
TEST(RetargetBodies, WithLeftAndRightExchangedAreNotSilent) {
  const RetargetScene scene;
  MadeBodyRule rule;
  const auto nodes = write_made_body(rule, scene / "body.glb");
  std::ofstream map(scene / "body.bones.toml");
  map << "front = \"+Z\"\n\n[bones]\n";
  for (const auto& [bone, node] : nodes) {
    if (mirrored(bone) == bone) continue;
    map << name(bone) << " = \"" << nodes.at(mirrored(bone)) << "\"\n";
  }
  map.close();
  const ProgramRun run =
      scene.marey({"retarget", "walk.bvh", "body.glb", "--out", "o.glb"});
  EXPECT_NE(run.exit_code, 0) << run.err;
  EXPECT_TRUE(run.err.find("left") != std::string::npos) << run.err;
}

}  // namespace
}  // namespace marey::testing
