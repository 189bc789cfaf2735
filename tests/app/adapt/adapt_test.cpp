// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey adapt` on files: what it writes, measured by forward kinematics.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "tests/app/adapt/adapt_scene.h"

namespace marey::testing {
namespace {

using B = HumanBone;
using Json = nlohmann::json;

// Six decimals of a centimetre and of a degree over a body's height: 5e-9 m, and 3e-8 m
// for each joint of a chain; postures are solved in single precision (1e-7 of a metre
// each step).
constexpr double kFile_m = 2e-5;
constexpr double kPrecision_m = 1e-3;  // The default precision of a constraint.

/// Returns a place that the walking hand reaches from 1 s to 1.4 s: in front of its
/// place halfway.
glm::dvec3 in_reach(const AdaptScene& scene) {
  return place_of(scene.walk().motion, 36, B::kLeftHand) + glm::dvec3(0.05, 0.35, 0.15);
}

/// Frames in which a foot truly bears, away from where it begins and ends, in runs.
std::vector<std::vector<int>> runs_of(const std::vector<char>& bears) {
  constexpr int kEdge = 2;  // Contacts are found to two frames (detect_contacts_test).
  std::vector<std::vector<int>> runs;
  std::vector<int> run;
  const auto end_run = [&] {
    if (run.size() > 2 * kEdge) {
      runs.emplace_back(run.begin() + kEdge, run.end() - kEdge);
    }
    run.clear();
  };
  for (std::size_t t = 0; t < bears.size(); ++t) {
    if (bears[t] != 0) run.push_back(static_cast<int>(t));
    if (bears[t] == 0) end_run();
  }
  end_run();
  return runs;
}

/// Returns the largest displacement of a joint while it should stand.
double slide_m(const Motion& motion, const std::vector<char>& bears, B bone) {
  double worst = 0.0;
  for (const std::vector<int>& run : runs_of(bears)) {
    for (const int t : run) {
      worst = std::max(
          worst,
          glm::distance(place_of(motion, t, bone), place_of(motion, run.front(), bone)));
    }
  }
  return worst;
}

/// The largest distance of any joint from where another motion has it.
double apart_m(const Motion& a, const Motion& b, int frame) {
  const auto t = static_cast<std::size_t>(frame);
  const auto x = world_from_joints(a.skeleton, a.poses[t]);
  const auto y = world_from_joints(b.skeleton, b.poses[t]);
  double worst = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    worst = std::max(worst, glm::distance(x[j].translation, y[j].translation));
  }
  return worst;
}

TEST(Adapt, KeepsAWristOnAPointAndTheFeetOnTheFloor) {
  const AdaptScene scene;
  const glm::dvec3 target = in_reach(scene);
  const ProgramRun run =
      scene.adapt({"--constraints", scene.constraints(hand_at(target))});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Motion motion = scene.motion();
  ASSERT_EQ(motion.poses.size(), 90U);
  EXPECT_DOUBLE_EQ(motion.rate.hz, 30.0);
  double max_asked_m = 0.0;
  double worst_m = 0.0;
  for (int t = 30; t <= 42; ++t) {
    max_asked_m =
        std::max(max_asked_m,
                 glm::distance(place_of(scene.walk().motion, t, B::kLeftHand), target));
    worst_m = std::max(worst_m, glm::distance(place_of(motion, t, B::kLeftHand), target));
  }
  EXPECT_GT(max_asked_m, 0.3) << "nothing was asked";
  EXPECT_LT(worst_m, kPrecision_m + kFile_m);
  for (std::size_t side = 0; side < 2; ++side) {
    const SyntheticWalk::Foot& foot = scene.walk().feet[side];
    const bool left = side == 0;
    EXPECT_LT(slide_m(motion, foot.heel, left ? B::kLeftFoot : B::kRightFoot), 1e-4);
    EXPECT_LT(slide_m(motion, foot.ball, left ? B::kLeftToes : B::kRightToes), 1e-4);
  }
  // Long after, the walk is what it was but for the ground (mm).
  EXPECT_LT(apart_m(motion, scene.walk().motion, 80), 0.01);

  const Json report = Json::parse(run.out);
  const Json& hand = of_id(report.at("constraints"), "hand");
  EXPECT_EQ(hand.at("active_frames"), 13);
  EXPECT_EQ(hand.at("met_frames"), hand.at("active_frames"));
  EXPECT_NEAR(hand.at("worst_error_mm").get<double>(), 1e3 * worst_m, 1e3 * kFile_m);
  EXPECT_LT(report.at("worst_support_mm").get<double>(), 0.1);
  EXPECT_GE(report.at("supports").size(), 4U);
}

TEST(Adapt, KeepsNamesAndJointsAndIsTheSameEveryTime) {
  const AdaptScene scene;
  const std::string set = scene.constraints(hand_at(in_reach(scene)));
  ASSERT_EQ(scene.adapt({"--constraints", set}).exit_code, 0);
  const std::string first = *recordings::read_file(scene / "out.bvh");
  ASSERT_EQ(scene.adapt({"--constraints", set}).exit_code, 0);
  EXPECT_EQ(*recordings::read_file(scene / "out.bvh"), first);
  const Skeleton now = scene.motion().skeleton;
  const Skeleton was = scene.motion("walk.bvh").skeleton;
  ASSERT_EQ(now.joints.size(), was.joints.size());
  for (std::size_t j = 0; j < now.joints.size(); ++j) {
    EXPECT_EQ(now.joints[j].name, was.joints[j].name);
  }
}

TEST(Adapt, KeepsAMotionWithoutConstraints) {
  const AdaptScene scene;
  ASSERT_EQ(scene.adapt({"--supports", "none"}).exit_code, 0);
  const Motion motion = scene.motion();
  for (int t = 0; t < 90; ++t) {
    ASSERT_LT(apart_m(motion, scene.walk().motion, t), kFile_m) << t;
  }
}

// A stage 0.4 m high: the whole walk is on it.
TEST(Adapt, StandsOnAFloorOfAnyHeight) {
  const AdaptScene scene;
  ASSERT_EQ(scene.adapt({}).exit_code, 0);
  const Motion below = scene.motion();
  ASSERT_EQ(scene.adapt({"--floor-height", "0.4"}).exit_code, 0);
  const Motion above = scene.motion();
  for (int t = 0; t < 90; t += 10) {
    const double rise_m =
        place_of(above, t, B::kRightToes).y - place_of(below, t, B::kRightToes).y;
    EXPECT_NEAR(rise_m, 0.4, 5e-3);  // Feet of the walk rest there, to millimetres.
  }
}

/// A lift of 0.1 m that the walk steps onto, higher and aside until 2.5 s.
std::string lift_file(const AdaptScene& scene) {
  return scene.file("floor.toml",
                    "format = 1\n[[part]]\nname = \"lift\"\nx_m = [-2, 2]\n"
                    "z_m = [0.8, 9]\ntop_m = 0.1\ntimes_s = [0.5, 1.5, 2.5]\n"
                    "moved_m = [[0, 0, 0], [0.1, 0.1, 0], [0.2, 0.1, 0]]\n");
}

TEST(Adapt, StandsOnAMovingFloor) {
  const AdaptScene scene;
  ASSERT_EQ(scene.adapt({}).exit_code, 0);
  const Motion level = scene.motion();
  const ProgramRun run = scene.adapt({"--floor", lift_file(scene)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  EXPECT_LT(report.at("worst_slide_mm").get<double>(), 0.1);
  EXPECT_LT(report.at("worst_support_mm").get<double>(), 0.1);
  int on_lift = 0;
  int on_base = 0;
  for (const Json& support : report.at("supports")) {
    for (const Json& stance : support.at("stands")) {
      (stance.at("on") == "lift" ? on_lift : on_base) += 1;
      EXPECT_LE(stance.at("from_s").get<double>(), stance.at("to_s").get<double>());
      EXPECT_LT(stance.at("slide_mm").get<double>(), 0.1);
    }
  }
  EXPECT_GE(on_lift, 3);
  EXPECT_GE(on_base, 3);
  const glm::dvec3 carried =
      place_of(scene.motion(), 85, B::kHips) - place_of(level, 85, B::kHips);
  EXPECT_NEAR(carried.y, 0.2, 0.01);
  EXPECT_GT(carried.x, 0.02);
}

// A step that is higher than legs are long.
TEST(Adapt, ReportsAFloorThatLegsDoNotReach) {
  const AdaptScene scene;
  const std::string parts =
      scene.file("floor.toml",
                 "format = 1\n[[part]]\nname = \"cliff\"\nx_m = [-2, 2]\nz_m = [0.8, 9]\n"
                 "top_m = 1.5\n");
  const ProgramRun run = scene.adapt({"--floor", parts});
  EXPECT_NE(run.err.find("floor.toml: in "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("frames a standing leg does not reach it"), std::string::npos)
      << run.err;
  EXPECT_GT(Json::parse(run.out).at("floor_out_of_reach_frames").get<int>(), 0);
  const ProgramRun low = scene.adapt({"--floor", lift_file(scene)});
  EXPECT_EQ(Json::parse(low.out).at("floor_out_of_reach_frames").get<int>(), 0);
  EXPECT_EQ(low.err.find("does not reach"), std::string::npos) << low.err;
}

TEST(Adapt, ALevelFloorIsNoFloor) {
  const AdaptScene scene;
  ASSERT_EQ(scene.adapt({}).exit_code, 0);
  const std::string without = *recordings::read_file(scene / "out.bvh");
  ASSERT_EQ(scene.adapt({"--floor", scene.file("floor.toml", "format = 1\n")}).exit_code,
            0);
  EXPECT_EQ(*recordings::read_file(scene / "out.bvh"), without);
}

// A file's support holds a foot at the file's place. The program adds no other support.
TEST(Adapt, TakesItsSupportsFromTheFileWhenItHasAny) {
  const AdaptScene scene;
  const Motion& walk = scene.walk().motion;
  const glm::dvec3 print = place_of(walk, 6, B::kLeftFoot) + glm::dvec3(0.05, 0.0, 0.05);
  const auto number = [](double x) { return std::to_string(x); };
  const std::string set = scene.constraints(
      "<Support><name>step</name><stop_time>0.3</stop_time>"
      "<stop_duration>0.2</stop_duration>"
      "<bodyPoint><segment>leftFoot</segment></bodyPoint><specif><position><X>" +
      number(print.x) + "</X><Y>" + number(print.y) + "</Y><Z>" + number(print.z) +
      "</Z></position></specif></Support>");
  const ProgramRun run = scene.adapt({"--constraints", set});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Motion motion = scene.motion();
  for (int t = 0; t < 9; ++t) {
    EXPECT_LT(glm::distance(place_of(motion, t, B::kLeftFoot), print), 1e-4) << t;
  }
  EXPECT_TRUE(Json::parse(run.out).at("supports").empty());
  const Json both =
      Json::parse(scene.adapt({"--constraints", set, "--supports", "auto"}).out);
  ASSERT_FALSE(both.at("supports").empty());
  for (const Json& one : both.at("supports")) {
    EXPECT_NE(one.at("id").get<std::string>().find("right"), std::string::npos);
  }
}

// A bag of 10 kg in the left hand: the centre of mass stays where it was without it.
TEST(Adapt, ACarriedLoadMovesTheBodyAgainstIt) {
  const AdaptScene scene;
  const std::string who = scene.character(
      "avatar = \"walk.bvh\"\nmass_kg = 70.0\n[[load]]\nname = \"bag\"\n"
      "segment = \"leftHand\"\nmass_kg = 10.0\n");
  const std::vector<std::string> balanced{"--character", who, "--balance", "horizontal"};
  ASSERT_EQ(scene.adapt(balanced).exit_code, 0);
  const Motion empty_handed = scene.motion();
  std::vector<std::string> loaded = balanced;
  loaded.insert(loaded.end(), {"--load", "bag"});
  const ProgramRun run = scene.adapt(loaded);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  EXPECT_LT(report.at("balance").at("worst_error_mm").get<double>(), 5.0);
  EXPECT_EQ(report.at("character"), "Ann");
  // A seventh of the mass, 0.2 m to the left: the hips go right, against it.
  EXPECT_LT(place_of(scene.motion(), 40, B::kHips).x,
            place_of(empty_handed, 40, B::kHips).x - 0.005);
}

TEST(Adapt, PutsTheMotionOnTheCharactersBodyFirst) {
  const AdaptScene scene;
  const std::string who = scene.character("stature_m = 1.2\n");
  const ProgramRun run = scene.adapt({"--character", who});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Motion motion = scene.motion();
  const Proportions child = average_proportions(1.2);
  const auto shank = motion.skeleton.find(B::kLeftFoot);
  ASSERT_TRUE(shank);
  EXPECT_NEAR(glm::length(motion.skeleton[*shank].parent_from_joint.translation),
              glm::length(child[B::kLeftFoot]),
              1e-7);
  EXPECT_LT(slide_m(motion, scene.walk().feet[0].heel, B::kLeftFoot), 1e-4);
}

TEST(Adapt, WritesAMannequinThatMovesTheSame) {
  const AdaptScene scene;
  const std::string set = scene.constraints(hand_at(in_reach(scene)));
  ASSERT_EQ(scene.adapt({"--constraints", set}).exit_code, 0);
  ASSERT_EQ(scene.adapt({"--constraints", set, "--out", (scene / "out.glb").string()})
                .exit_code,
            0);
  const auto glb = recordings::read_character(scene / "out.glb");
  ASSERT_TRUE(glb) << glb.error().message();
  ASSERT_TRUE(glb->mesh && glb->motion);
  EXPECT_NEAR(glb->motion->rate.hz, 30.0, 1e-3);
  EXPECT_LT(apart_m(*glb->motion, scene.motion(), 36), 1e-5);  // Single precision.
}

// The program reports the misses, writes the motion, and ends with exit code 4.
TEST(Adapt, ReportsMissedConstraints) {
  const AdaptScene scene;
  const std::string set = scene.constraints(hand_at({0.0, 5.0, 1.0}));
  const ProgramRun run = scene.adapt({"--constraints", set});
  EXPECT_EQ(run.exit_code, 4);
  for (const char* part :
       {"out.bvh: constraint \"hand\": missed in 13 of 13 frames", "mm (at ", "Next: "}) {
    EXPECT_NE(run.err.find(part), std::string::npos) << part << " in " << run.err;
  }
  const Motion motion = scene.motion();
  EXPECT_LT(slide_m(motion, scene.walk().feet[0].heel, B::kLeftFoot), 1e-4)
      << "a support has priority over other constraints";
  // A blend has no required precision. The program reports the misses, and ends with 0.
  const ProgramRun blend = scene.adapt({"--constraints", set, "--control", "blend"});
  EXPECT_EQ(blend.exit_code, 0) << blend.err;
  EXPECT_NE(blend.err.find("c.xml: constraint \"hand\": missed in 13 of 13 frames"),
            std::string::npos)
      << blend.err;
}

TEST(Adapt, ReportsAFootprintOutOfReach) {
  const AdaptScene scene;
  const ProgramRun run = scene.adapt(
      {"--root-share",
       "0",
       "--constraints",
       scene.constraints(
           "<Support><name>far</name><bodyPoint><segment>leftFoot</segment></bodyPoint>"
           "<specif><position><X>0.1</X><Y>0.1</Y><Z>0</Z></position></specif></Support>"
           "<Support><name>further</name><bodyPoint><segment>rightFoot</segment>"
           "</bodyPoint><specif><position><X>-4</X><Y>0.1</Y><Z>0</Z></position></specif>"
           "</Support>")});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("error: "), std::string::npos);
  EXPECT_NE(run.err.find("support \"f"), std::string::npos) << run.err;
}

TEST(Adapt, ReportsConstraintsThatNeverHold) {
  const AdaptScene scene;
  std::string late = hand_at(in_reach(scene));
  for (const auto& [from, to] :
       {std::pair("0.79<", "80.0<"), std::pair("1.41<", "81.0<")}) {
    late.replace(late.find(from), std::string(from).size(), to);
  }
  const ProgramRun run = scene.adapt({"--constraints", scene.constraints(late)});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.err.find("active in no frame"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace marey::testing
