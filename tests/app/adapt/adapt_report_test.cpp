// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Reports of `marey adapt` on requests that it does not meet, and its advice.
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "tests/app/adapt/adapt_scene.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using B = HumanBone;
using Json = nlohmann::json;

/// A captured walk, its bones called as VRM does. nullopt: it is not at hand.
std::optional<std::string> bandai_walk() {
  const auto text = recordings::read_file(marey::testing::shared_data() /
                                          "mocap/bandai/dataset-1_walk_normal_001.bvh");
  if (!text) return std::nullopt;
  std::string out = *text;
  const auto rename = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = out.find(" " + from + "\n", at)) != out.npos;) {
      out.replace(at + 1, from.size(), to);
    }
  };
  for (const char* bone : {"Hips", "Spine", "Chest", "Neck", "Head"}) {
    std::string to = bone;
    to[0] = static_cast<char>(to[0] - 'A' + 'a');
    rename(bone, to);
  }
  for (const char* bone : {"Shoulder",
                           "UpperArm",
                           "LowerArm",
                           "Hand",
                           "UpperLeg",
                           "LowerLeg",
                           "Foot",
                           "Toes"}) {
    rename(std::string(bone) + "_L", std::string("left") + bone);
    rename(std::string(bone) + "_R", std::string("right") + bone);
  }
  return out;
}

// The captured walk exceeds an adult's limits in places. Supports take priority over
// limits.
TEST(Adapt, SupportsOfACapturedWalkAreExactWithinLimits) {
  const AdaptScene scene;
  const auto walk = bandai_walk();
  if (!walk) GTEST_SKIP() << "the captured walk is missing";
  scene.file("walk.bvh", *walk);
  const ProgramRun run = scene.adapt({});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(run.out);
  ASSERT_GE(report.at("supports").size(), 4U);
  EXPECT_LT(report.at("worst_support_mm").get<double>(), 0.1) << run.err;
}

// A head cannot look back. The report gives the error as an angle.
TEST(Adapt, ReportsAnOrientationErrorInDegrees) {
  const AdaptScene scene;
  const ProgramRun run = scene.adapt(
      {"--constraints",
       scene.constraints("<Orientation><name>look</name><range>1</range><bodyPoint>"
                         "<segment>head</segment></bodyPoint><specif><orientation>"
                         "<W>0</W><X>0</X><Y>1</Y><Z>0</Z></orientation></specif>"
                         "</Orientation>")});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find(" degrees (at "), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("mm (at"), std::string::npos) << run.err;
  const Json report = Json::parse(run.out);
  const Json& look = of_id(report.at("constraints"), "look");
  EXPECT_EQ(look.at("met_frames"), 0);
  // The target is 180 degrees, a head turns by 95 at most, and the walk looks ahead.
  EXPECT_GT(look.at("worst_error_deg").get<double>(), 70.0);
  EXPECT_LE(look.at("worst_error_deg").get<double>(), 180.0);
  EXPECT_FALSE(look.contains("worst_error_mm"));
}

// A load of a ton at one foot keeps the centre of mass there, in every posture.
TEST(Adapt, AdvisesMoreIterationsOnlyIfTheyWereUsedUp) {
  const AdaptScene scene;
  const std::string who = scene.character(
      "avatar = \"walk.bvh\"\nmass_kg = 70.0\n[[load]]\nname = \"ball\"\n"
      "segment = \"leftFoot\"\nmass_kg = 1000.0\n");
  const auto advice = [&](const std::string& maximum) {
    const ProgramRun run = scene.adapt({"--character",
                                        who,
                                        "--load",
                                        "ball",
                                        "--balance",
                                        "horizontal",
                                        "--balance-root-share",
                                        "0",
                                        "--max-iterations",
                                        maximum});
    const bool capped = Json::parse(run.out).at("iterations").at("frames_at_cap") > 0;
    EXPECT_EQ(capped, maximum == "5") << run.out;
    const std::size_t at = run.err.find("the centre of mass is up to");
    EXPECT_NE(at, std::string::npos) << run.err;
    return run.err.substr(at, run.err.find('\n', at) - at);
  };
  EXPECT_NE(advice("5").find("more than 5 with --max-iterations"), std::string::npos);
  const std::string patient = advice("2000");
  EXPECT_EQ(patient.find("--max-iterations"), std::string::npos) << patient;
  EXPECT_NE(patient.find("--balance-root-share 1"), std::string::npos) << patient;
}

/// Constraints of both hands and nothing else, while hand_at()'s is active.
std::string both_hands_at(const glm::dvec3& left, const glm::dvec3& right) {
  std::string second = hand_at(right, "", "rightHand");
  second.replace(second.find("<name>hand<"), 11, "<name>other<");
  return hand_at(left) + second;
}

// The constraint is met with a hand below the floor.
TEST(Adapt, DoesNotTrustAHandBelowTheFloor) {
  const AdaptScene scene;
  // The root goes down with it, and nothing else is far.
  glm::dvec3 low = place_of(scene.walk().motion, 36, B::kLeftHand);
  low.y = -0.2;
  const ProgramRun run = scene.adapt(
      {"--constraints", scene.constraints(hand_at(low)), "--supports", "none"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  for (const char* word : {" mm below the floor", "frame ", "\"hand\""}) {
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
  }
  EXPECT_GT(Json::parse(run.out).at("posture").at("below_floor_mm").get<double>(), 150.0);
}

TEST(Adapt, DoesNotTrustATrunkUpsideDown) {
  const AdaptScene scene;
  const glm::dvec3 foot = place_of(scene.walk().motion, 36, B::kLeftFoot);
  const ProgramRun run =
      scene.adapt({"--constraints",
                   scene.constraints(both_hands_at({foot.x, -1.2, foot.z - 0.4},
                                                   {foot.x - 0.3, -1.2, foot.z - 0.4})),
                   "--control",
                   "blend"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  for (const char* word : {"the trunk is upside down", "\"hand\", \"other\"", "frame "}) {
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
  }
  EXPECT_GT(Json::parse(run.out).at("posture").at("upside_down_frames").get<int>(), 0);
}

// More iterations do not reach a target that is out of reach.
TEST(Adapt, AdvisesNoIterationsForATargetOutOfReach) {
  const AdaptScene scene;
  for (const double height_m : {5.0, 2.4}) {
    const ProgramRun run = scene.adapt({"--constraints",
                                        scene.constraints(hand_at({0.0, height_m, 1.0})),
                                        "--max-iterations",
                                        "1"});
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_EQ(run.err.find("--max-iterations"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("nearer"), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace marey::testing
