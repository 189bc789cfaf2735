// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey retarget`: the files that it writes.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/motion/bvh.h"
#include "tests/app/retarget_scene.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

using Json = nlohmann::json;

TEST(Retarget, PutsAMotionOnSeveralBodiesInEveryFormatThatTheyCanHave) {
  const RetargetScene scene;
  const ProgramRun run = scene.retarget(
      {"small.glb", "tall.glb", "-a", "plain.bvh", "--out", "all", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"small", "tall"}) {
    const Motion glb = scene.motion(std::string("all/") + name + ".glb");
    const Motion bvh = scene.motion(std::string("all/") + name + ".bvh");
    const Motion vrma = scene.motion(std::string("all/") + name + ".vrma");
    EXPECT_EQ(glb.poses.size(), 120U);
    EXPECT_EQ(bvh.rate.hz, 60.0);
    for (const HumanBone bone : {HumanBone::kLeftHand, HumanBone::kRightFoot}) {
      EXPECT_LT(apart_m(glb, bvh, bone), 1e-5);
      EXPECT_LT(apart_m(glb, vrma, bone), 1e-5);
    }
  }
  EXPECT_FALSE(scene.has("all/plain.glb")) << "it has no mesh";
  EXPECT_TRUE(scene.has("all/plain.bvh") && scene.has("all/plain.vrma"));
  const Json figures = Json::parse(run.out).at("avatars");
  ASSERT_EQ(figures.size(), 3U);
  for (const Json& body : figures) {
    EXPECT_LT(body.at("contacts").at("slide_cm_per_s"), 0.01);
    EXPECT_LT(body.at("contacts").at("worst_drift_mm"), 0.1);
    EXPECT_LT(body.at("contacts").at("sinking_mm"), 0.1);
    EXPECT_GT(body.at("contacts").at("drifts").size(), 4U);
    // Captured motions stay below 1.1; this one has corners only where feet land.
    EXPECT_LT(body.at("contacts").at("jerk_over_source"), 1.3);
  }
}

TEST(Retarget, WritesTheFileFormatOfOneBodyByItsName) {
  const RetargetScene scene;
  for (const char* out : {"o.glb", "o.bvh", "o.vrma", "o.npz", "o.csv", "o.mot"}) {
    const ProgramRun run =
        scene.retarget({"--avatar", "small.glb", "--out", out, "--json"});
    ASSERT_EQ(run.exit_code, 0) << out << ": " << run.err;
    const Json figures = Json::parse(run.out);
    EXPECT_EQ(figures.at("out"), out);
    EXPECT_EQ(figures.at("frames"), 120);
    EXPECT_LT(figures.at("slide_after_cm_per_s"), 0.01);
    EXPECT_TRUE(scene.has(out));
  }
  EXPECT_LT(apart_m(scene.motion("o.glb"), scene.motion("o.bvh"), HumanBone::kHead),
            1e-5);
}

TEST(Retarget, GivesTheSameBytesAgain) {
  const RetargetScene scene;
  const std::vector<std::string> what{
      "small.glb", "plain.bvh", "--formats", "glb,bvh,vrma,npz,csv", "--report", "--out"};
  for (const char* folder : {"a", "b"}) {
    std::vector<std::string> more = what;
    more.emplace_back(folder);
    ASSERT_EQ(scene.retarget(more).exit_code, 0);
  }
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scene / "a")) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(scene.bytes("a/" + name), scene.bytes("b/" + name)) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 5 + 4 + 1);  // plain.bvh has no mesh.
}

// Every second frame of 60 Hz is one of 30 Hz; in all others feet stand as well.
TEST(Retarget, ResamplesSoThatSharedInstantsAreTheSameAndFeetStand) {
  const RetargetScene scene;
  ASSERT_EQ(scene.retarget({"small.glb", "--out", "full.bvh"}).exit_code, 0);
  ASSERT_EQ(scene.retarget({"small.glb", "--out", "half.bvh", "--rate", "30"}).exit_code,
            0);
  Motion full = scene.motion("full.bvh");
  const Motion half = scene.motion("half.bvh");
  EXPECT_EQ(half.rate.hz, 30.0);
  ASSERT_EQ(half.poses.size(), 60U);
  for (std::size_t t = 0; t < 60; ++t) full.poses[t] = full.poses[2 * t];
  full.poses.resize(60);
  EXPECT_LT(apart_m(full, half, HumanBone::kLeftFoot), 1e-7);
  for (const char* rate : {"24", "25", "144"}) {
    const ProgramRun run =
        scene.retarget({"small.glb", "--out", "o.bvh", "--rate", rate, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_LT(Json::parse(run.out).at("slide_after_cm_per_s"), 0.01) << rate;
    EXPECT_EQ(scene.motion("o.bvh").rate.hz, std::stod(rate));
  }
}

TEST(Retarget, NamesTheClipAndWritesTheDialect) {
  const RetargetScene scene;
  ASSERT_EQ(scene
                .retarget({"small.glb",
                           "--out",
                           "o",
                           "--clip",
                           "A long walk",
                           "--bvh-dialect",
                           "mobu"})
                .exit_code,
            0);
  EXPECT_NE(scene.bytes("o/small.glb").find("\"A long walk\""), std::string::npos);
  EXPECT_NE(scene.bytes("o/small.vrma").find("\"A long walk\""), std::string::npos);
  EXPECT_NE(scene.bytes("o/small.bvh").find("LeftUpLeg"), std::string::npos);
}

/// Returns the travel of the hips along Z. [m]
double way_m(const Motion& motion) {
  return motion.poses.back().root_in_world.z - motion.poses.front().root_in_world.z;
}

TEST(Retarget, KeepsTheWayInMetresIfAsked) {
  const RetargetScene scene;
  const auto way = [&](const std::string& path) {
    const ProgramRun run =
        scene.retarget({"tall.glb", "--path", path, "--out", path + ".bvh", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_LT(Json::parse(run.out).at("slide_after_cm_per_s"), 0.01);
    return way_m(scene.motion(path + ".bvh"));
  };
  EXPECT_NEAR(way("kept"), way_m(scene.motion("walk.bvh")), 1e-5);
  EXPECT_GT(way("scaled"), 1.2 * way("kept"));
}

TEST(Retarget, ReportsWhetherBodiesAreOverTheirFeetAndKeepsThemThere) {
  const RetargetScene scene;
  const ProgramRun without =
      scene.retarget({"small.glb", "plain.bvh", "--out", "a", "--json", "--report"});
  ASSERT_EQ(without.exit_code, 0) << without.err;
  const ProgramRun with = scene.retarget(
      {"small.glb", "plain.bvh", "--balance", "--out", "b", "--json", "--report"});
  ASSERT_EQ(with.exit_code, 0) << with.err;
  for (std::size_t i = 0; i < 2; ++i) {
    const Json before = Json::parse(without.out).at("avatars")[i].at("balance");
    const Json after = Json::parse(with.out).at("avatars")[i].at("balance");
    EXPECT_FALSE(before.at("kept"));
    EXPECT_TRUE(after.at("kept"));
    EXPECT_GT(before.at("supported_frames"), 60);
    EXPECT_EQ(before.at("source_over_percent"), after.at("source_over_percent"));
    EXPECT_LE(after.at("mean_off_mm"), after.at("mean_off_before_mm"));
    EXPECT_FALSE(before.contains("root_moved_mm"));
  }
  for (const char* page : {"a/retarget.html", "b/retarget.html"}) {
    EXPECT_NE(scene.bytes(page).find("Centre of mass and the feet"), std::string::npos);
    EXPECT_NE(scene.bytes(page).find("Zero moment point inside"), std::string::npos);
  }
}

TEST(Retarget, ScalesTheWayOfTheRootAsAsked) {
  const RetargetScene scene;
  for (const char* root : {"leg-length", "arm-length", "none"}) {
    ASSERT_EQ(scene
                  .retarget({"small.glb",
                             "--no-ground",
                             "--root",
                             root,
                             "--out",
                             std::string(root) + ".bvh"})
                  .exit_code,
              0);
  }
  const double truth_m = way_m(scene.walk().motion);
  EXPECT_NEAR(way_m(scene.motion("none.bvh")), truth_m, 1e-5);
  EXPECT_NEAR(way_m(scene.motion("leg-length.bvh")), truth_m * 0.9 / 1.75, 0.02);
  EXPECT_NEAR(way_m(scene.motion("arm-length.bvh")), truth_m * 0.9 / 1.75, 0.02);
}

TEST(Retarget, LiveIsPostureByPosture) {
  const RetargetScene scene;
  const ProgramRun whole = scene.retarget({"small.glb", "--out", "whole.bvh", "--json"});
  const ProgramRun live =
      scene.retarget({"small.glb", "--out", "live.bvh", "--live", "--json"});
  ASSERT_EQ(live.exit_code, 0) << live.err;
  EXPECT_TRUE(Json::parse(live.out).at("live"));
  // It cannot know that a foot will land: it slides more than when all is known.
  EXPECT_GT(Json::parse(live.out).at("slide_after_cm_per_s"),
            Json::parse(whole.out).at("slide_after_cm_per_s"));
  EXPECT_LT(Json::parse(live.out).at("slide_after_cm_per_s"), 1.5);
  // The first half does not depend on the second, which another run never sees.
  Motion first = scene.motion("live.bvh");
  first.poses.resize(60);
  std::string half = *recordings::read_file(scene / "walk.bvh");
  const std::string frames = "Frames: 120\n";
  half.replace(half.find(frames), frames.size(), "Frames: 60\n");
  std::size_t end = half.find('\n', half.find("Frame Time:"));
  for (int frame = 0; frame < 60; ++frame) end = half.find('\n', end + 1);
  half.resize(end + 1);
  ASSERT_TRUE(recordings::write_file(scene / "half.bvh", half));
  ASSERT_EQ(
      scene.marey({"retarget", "half.bvh", "small.glb", "--out", "live2.bvh", "--live"})
          .exit_code,
      0);
  const Motion second = scene.motion("live2.bvh");
  ASSERT_EQ(second.poses.size(), 60U);
  EXPECT_EQ(apart_m(first, second, HumanBone::kLeftFoot), 0.0);
}

// The constraint file, given to `marey adapt`, keeps the feet as exactly where they are.
TEST(Retarget, WritesSupportsThatAdaptReadsAgain) {
  const RetargetScene scene;
  ASSERT_EQ(scene.retarget({"tall.glb", "--out", "o.bvh", "--constraints-out", "s.xml"})
                .exit_code,
            0);
  const auto file = recordings::read_constraints(scene / "s.xml");
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_TRUE(file->notes.empty());
  EXPECT_TRUE(file->set.find("leftFoot flat 1"));
  const ProgramRun run = scene.marey(
      {"adapt", "o.bvh", "--constraints", "s.xml", "--out", "adapted.bvh", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("added acceleration"), std::string::npos) << run.err;
  const Json kept = Json::parse(run.out).at("constraints");
  EXPECT_EQ(kept.size(), file->set.constraints.size());
  for (const Json& one : kept) {
    EXPECT_GT(one.at("active_frames"), 0) << one;
    EXPECT_LT(one.at("worst_error_mm"), 0.01) << one;
  }
  const Motion before = scene.motion("o.bvh");
  const Motion after = scene.motion("adapted.bvh");
  // A support that fades in holds the landing foot back a little, and the body with it.
  EXPECT_LT(apart_m(before, after, HumanBone::kHead), 5e-3);
}

// Returns a motion that lowers the left arm until its hand lies at the thigh.
Motion hand_to_thigh() {
  Motion motion{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const JointIndex arm = *motion.skeleton.find(HumanBone::kLeftUpperArm);
  for (int t = 0; t < 120; ++t) {
    const double x = std::min(t / 40.0, 1.0);
    Pose pose = rest_pose(motion.skeleton);
    pose.parent_from_joint[index(arm)] =
        glm::angleAxis(-0.9 - 0.76 * x * x * (3.0 - 2.0 * x), glm::dvec3(0, 0, 1));
    motion.poses.push_back(std::move(pose));
  }
  return motion;
}

TEST(Retarget, ProposesWhatHandsTouchAsConstraintsThatAdaptMeets) {
  const RetargetScene scene;
  ASSERT_TRUE(recordings::write_bvh(scene / "hand.bvh", hand_to_thigh()));
  ASSERT_EQ(scene
                .marey({"retarget",
                        "hand.bvh",
                        "small.glb",
                        "--out",
                        "o.bvh",
                        "--constraints-out",
                        "s.xml"})
                .exit_code,
            0);
  const auto file = recordings::read_constraints(scene / "s.xml");
  ASSERT_TRUE(file);
  int touches = 0;
  for (const Constraint& one : file->set.constraints) {
    if (!std::holds_alternative<DistanceToBody>(one.goal)) continue;
    ++touches;
    EXPECT_EQ(one.id.find("left hand on "), 0U) << one.id;
    EXPECT_EQ(one.point.segment, "leftHand");
    // It fades in before the hand lies there, and stays to the end.
    ASSERT_TRUE(one.activation.start_s);
    EXPECT_LT(*one.activation.start_s, 40.0 / 60.0);
    EXPECT_GT(one.activation.start_duration_s, 0.2);
    EXPECT_FALSE(one.activation.stop_s);
  }
  EXPECT_EQ(touches, 1);
  const ProgramRun run = scene.marey(
      {"adapt", "o.bvh", "--constraints", "s.xml", "--out", "adapted.bvh", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const Json& one : Json::parse(run.out).at("constraints")) {
    EXPECT_LT(one.at("worst_error_mm"), 5.0) << one;
  }
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos;
       at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

TEST(Retarget, ReportsEveryBodyWithItsFiguresContactsAndPictures) {
  const RetargetScene scene;
  const ProgramRun run = scene.retarget(
      {"small.glb", "bad.glb", "tall.glb", "--out", "all", "--report", "--json"});
  EXPECT_EQ(run.exit_code, 3);
  const std::string page = scene.bytes("all/retarget.html");
  EXPECT_EQ(count_of(page, "<svg class=\"strip\""), 3U) << "the source, too";
  EXPECT_EQ(count_of(page, "class=\"name\""), 3U);
  EXPECT_EQ(count_of(page, "<svg class=\"bars\""), 2U);
  EXPECT_EQ(count_of(page, "bad.glb: this is neither"), 1U);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("http:"), std::string::npos) << "it loads no other files";
  const std::string body = page.substr(page.find("<main>"));
  EXPECT_EQ(body.find("nan"), std::string::npos);
  EXPECT_EQ(body.find("inf"), std::string::npos);
  EXPECT_NE(body.find("href=\"small.vrma\""), std::string::npos);
  const Json source =
      Json::parse(run.out).at("avatars").at(0).at("contacts").at("source_slide_cm_per_s");
  std::array<char, 32> figure{};
  std::snprintf(figure.data(), figure.size(), ">%.2f cm/s<", source.get<double>());
  EXPECT_NE(page.find(figure.data()), std::string::npos) << figure.data();
  ASSERT_EQ(scene.retarget({"small.glb", "--out", "o.bvh", "--report"}).exit_code, 0);
  EXPECT_TRUE(scene.has("o.bvh.html"));
}

// CesiumMan faces +X in its file: the GLB that adapt writes, read again, contains the
// same motion as the BVH.
TEST(Retarget, IsAdaptedFurtherOnATurnedAvatar) {
  const std::filesystem::path avatar =
      marey::testing::shared_data() / "avatars/khronos/cesium_man.gltf";
  if (!std::filesystem::exists(avatar)) GTEST_SKIP() << avatar << " is not there";
  const RetargetScene scene;
  ASSERT_EQ(scene.retarget({avatar.string(), "--out", "o.glb"}).exit_code, 0);
  for (const char* out : {"adapted.glb", "adapted.bvh"}) {
    const ProgramRun run = scene.marey({"adapt", "o.glb", "--out", out});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  for (const char* out : {"of_glb.bvh", "of_bvh.bvh"}) {
    const std::string in = std::string("adapted.") + (out[3] == 'g' ? "glb" : "bvh");
    ASSERT_EQ(scene.marey({"retarget", in, "small.glb", "--out", out}).exit_code, 0);
  }
  for (const HumanBone bone : {HumanBone::kLeftHand, HumanBone::kRightFoot}) {
    EXPECT_LT(apart_m(scene.motion("of_glb.bvh"), scene.motion("of_bvh.bvh"), bone),
              1e-3);
  }
}

}  // namespace
}  // namespace marey::testing
