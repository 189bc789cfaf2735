// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// An avatar is judged by its written files.
#include "app/motion/reread_motion.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/motion/motion_files.h"
#include "recordings/gltf/posed_places.h"
#include "tests/app/retarget_scene.h"
#include "tests/support/bodies/made_body.h"
#include "tests/support/files/posed_glb.h"

namespace marey::app {
namespace {

using testing::RetargetScene;

Motion turned_round(Motion motion) {
  const glm::dquat half(0.0, 0.0, 1.0, 0.0);
  for (Pose& pose : motion.poses) {
    pose.root_in_world = half * pose.root_in_world;
    pose.parent_from_joint[0] = half * pose.parent_from_joint[0];
  }
  return motion;
}

// All formats that hold joints agree in place, heading and size.
TEST(RereadMotion, FindsTheMotionInEveryKindOfFile) {
  const RetargetScene scene;
  testing::MadeBodyRule rule;
  rule.centimetres = true;
  rule.facing_deg = 90.0;
  rule.z_up = true;
  testing::write_made_body(rule, scene / "body.glb");
  const auto run = scene.retarget(
      {"body.glb", "small.glb", "--formats", "glb,bvh,vrma,npz", "--json", "--out", "o"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  for (const auto& avatar : json.at("avatars")) {
    ASSERT_EQ(avatar.at("files").size(), 4U) << avatar;
    EXPECT_LT(avatar.at("reread_off_mm").get<double>(), 0.1) << avatar.at("avatar");
  }
}

TEST(RereadMotion, FindsSlowAndFastMotions) {
  const RetargetScene scene;
  Motion motion = scene.motion("walk.bvh");
  for (const double hz : {0.1, 5.0, 7.0, 7.5, 1000.0, 2000.0}) {
    motion.rate = FrameRate{hz};
    const auto out = scene / "rate.vrma";
    ASSERT_TRUE(write_motion_file(out, MotionFormat::kVrma, motion, {}));
    const auto same = reread_motion(written_file(out, MotionFormat::kVrma, {}), motion);
    ASSERT_TRUE(same) << hz << " Hz: " << same.error().message();
    EXPECT_EQ(same->has_value(), hz != 7.0) << hz;
    if (*same) {
      EXPECT_LT((*same)->worst_place_m, 1e-4) << hz;
    }
  }
}

TEST(RereadMotion, DetectsAFileOfAnotherFacingOrUnit) {
  const RetargetScene scene;
  const Motion motion = scene.motion("walk.bvh");
  const Motion turned = turned_round(motion);
  for (const MotionFormat format :
       {MotionFormat::kBvh, MotionFormat::kNpz, MotionFormat::kVrma}) {
    const auto out = scene / ("turned." + std::string(name(format)));
    ASSERT_TRUE(write_motion_file(out, format, turned, {}));
    const auto same = reread_motion(written_file(out, format, {}), turned);
    ASSERT_TRUE(same && *same) << (same ? "" : same.error().message());
    EXPECT_LT((*same)->worst_place_m, 1e-4) << name(format);
    const auto other = reread_motion(written_file(out, format, {}), motion);
    ASSERT_TRUE(other && *other);
    EXPECT_GT((*other)->worst_place_m, 0.05) << name(format);
    EXPECT_TRUE((*other)->worst_frame);
  }
  const auto bvh = reread_motion({scene / "turned.bvh", MotionFormat::kBvh, 1.0}, turned);
  ASSERT_TRUE(bvh && *bvh);
  EXPECT_GT((*bvh)->worst_place_m, 10.0);
  Motion shorter = turned;
  shorter.poses.pop_back();
  EXPECT_FALSE(
      reread_motion(written_file(scene / "turned.bvh", MotionFormat::kBvh, {}), shorter));
}

// The skin of the file, by code that shares nothing with the program.
TEST(RereadMotion, MeasuresTheSkinsDepthInTheFile) {
  const RetargetScene scene;
  testing::MadeBodyRule rule;
  rule.thick = 1.4;
  rule.two_skins = true;
  testing::write_made_body(rule, scene / "body.glb");
  ASSERT_EQ(scene.retarget({"body.glb", "--no-ground", "--formats", "glb", "--out", "o"})
                .exit_code,
            0);
  const auto read = recordings::read_posed_places(scene / "o/body.glb");
  ASSERT_TRUE(read) << read.error().message();
  testing::PosedGlb glb(scene / "o/body.glb");
  ASSERT_EQ(read->lowest_skin.size(), glb.times().size());
  for (std::size_t t = 0; t < glb.times().size(); t += 7) {
    glb.pose(glb.times()[t]);
    EXPECT_NEAR(read->lowest_skin[t], glb.lowest().y_m, 1e-4) << t;
  }
}

// The targets of inverse kinematics are mapped as feet. Their skin goes with the shanks,
// which is a warning: feet do not turn, and legs are right.
TEST(RereadMotion, ReportsOtherJointsThatAreMappedAsFeet) {
  const RetargetScene scene;
  testing::MadeBodyRule rule;
  rule.root_at_floor = true;
  rule.ik_bones = true;
  const auto nodes = testing::write_made_body(rule, scene / "body.glb");
  std::ofstream map(scene / "body.bones.toml");
  map << "[bones]\n";
  for (const auto& [bone, node] : nodes) {
    if (bone == HumanBone::kLeftToes || bone == HumanBone::kRightToes) continue;
    std::string joint = node;
    if (bone == HumanBone::kLeftFoot) joint = "IK_foot.L";
    if (bone == HumanBone::kRightFoot) joint = "IK_foot.R";
    map << name(bone) << " = \"" << joint << "\"\n";
  }
  map.close();
  const auto run = scene.retarget({"body.glb", "--out", "o.glb"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(
      run.err.find("warning: body.glb: the joint 'IK_foot.L' is mapped as leftFoot"),
      std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace marey::app
