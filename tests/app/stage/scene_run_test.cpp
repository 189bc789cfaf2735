// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/scene_run.h"

#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/app/stage/made_stage.h"

namespace marey::app::testing {
namespace {

constexpr double kStep_s = 1.0 / 60.0;

const std::string kAnn = "[[body]]\nid = \"ann\"\n";
const std::string kWave =
    "[[at]]\nid = \"wave\"\ntime_s = 0.5\nbody = \"ann\"\ndo = \"play\"\n"
    "clip = \"wave\"\n";

glm::dvec3 joint_of(const SceneRun& run,
                    std::size_t body,
                    HumanBone bone,
                    const Pose& pose) {
  const StageBody& who = run.body(body);
  const auto joints = world_from_joints(who.character.skeleton, pose);
  return joints[index(*who.map.joint_of[index(bone)])].translation;
}

const StageActionRun* run_of(const SceneRun& run, const std::string& id) {
  for (const StageActionRun& action : run.record().actions) {
    if (run.scene().script[action.action].id == id) return &action;
  }
  return nullptr;
}

TEST(SceneRun, GivesTheSameBytesForAnyNumberOfThreads) {
  const std::string text =
      "[[group]]\nid = \"crowd\"\ncount = 6\nstature_m = [1.2, 2.1]\n"
      "[[target]]\nid = \"ball\"\npath = \"lissajous\"\nframe = \"body\"\n"
      "for_stature_m = 1.75\nmiddle_m = [-0.2, 1.2, 0.4]\n"
      "amplitude_m = [0.1, 0.1, 0.05]\nfrequency_hz = [0.5, 0.7, 0.6]\n"
      "[[at]]\ntime_s = 0.2\nbody = \"crowd\"\ndo = \"constrain\"\n"
      "segment = \"rightHand\"\ntarget = \"ball\"\n";
  SceneRunInput two = made_stage_input(text);
  two.threads = 2;
  const SceneRun a = played(made_stage_input(text));
  const SceneRun b = played(std::move(two));
  for (std::size_t body = 0; body < a.size(); ++body) {
    const auto& one = a.record().tracks[body].poses;
    const auto& other = b.record().tracks[body].poses;
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t step = 0; step < one.size(); ++step) {
      ASSERT_EQ(one[step].root_in_world, other[step].root_in_world);
      ASSERT_EQ(one[step].parent_from_joint, other[step].parent_from_joint);
    }
  }
}

TEST(SceneRun, StartsActionsAtTheirTimesAndAfterOthers) {
  const SceneRun run =
      played(made_stage_input(kAnn + kWave +
                              "[[at]]\nid = \"next\"\nafter = \"wave\"\nbody = \"ann\"\n"
                              "do = \"play\"\nclip = \"wave\"\n"));
  const StageActionRun* first = run_of(run, "wave");
  const StageActionRun* next = run_of(run, "next");
  ASSERT_NE(first, nullptr);
  ASSERT_NE(next, nullptr);
  EXPECT_NEAR(first->start_s, 0.5, 1.5 * kStep_s);
  EXPECT_GE(next->start_s, first->end_s - 1e-9);
  EXPECT_LT(next->start_s, first->end_s + 2.5 * kStep_s);
}

TEST(SceneRun, StartsActionsAtEventsOfOthers) {
  const SceneRun run =
      played(made_stage_input(kAnn + kWave +
                              "[[target]]\nid = \"cup\"\npath = \"fixed\"\n"
                              "position_m = [0.3, 1.1, 0.4]\n"
                              "[[at]]\nid = \"hold\"\nafter = \"wave\"\n"
                              "event = \"impact\"\nbody = \"ann\"\ndo = \"constrain\"\n"
                              "segment = \"leftHand\"\ntarget = \"cup\"\n"));
  const StageActionRun* wave = run_of(run, "wave");
  const StageActionRun* hold = run_of(run, "hold");
  ASSERT_NE(hold, nullptr);
  ASSERT_EQ(wave->events.size(), 1U);
  EXPECT_EQ(wave->events[0].name, "impact");
  EXPECT_GE(hold->start_s, wave->events[0].time_s);
  EXPECT_LT(hold->start_s, wave->events[0].time_s + 2.5 * kStep_s);
}

TEST(SceneRun, EndsActionsThatAreStoppedOrLastForATime) {
  const SceneRun run = played(made_stage_input(
      kAnn +
      "[[target]]\nid = \"cup\"\npath = \"fixed\"\nposition_m = [0.3, 1.1, 0.4]\n"
      "[[at]]\nid = \"left\"\ntime_s = 0.2\nfor_s = 0.7\nbody = \"ann\"\n"
      "do = \"constrain\"\nsegment = \"leftHand\"\ntarget = \"cup\"\n"
      "[[at]]\nid = \"right\"\ntime_s = 0.2\nbody = \"ann\"\ndo = \"constrain\"\n"
      "segment = \"rightHand\"\ntarget = \"cup\"\n"
      "[[at]]\ntime_s = 1.5\nbody = \"ann\"\ndo = \"stop\"\naction = \"right\"\n"));
  EXPECT_NEAR(run_of(run, "left")->end_s, 0.9, 2.5 * kStep_s);
  EXPECT_NEAR(run_of(run, "right")->end_s, 1.5, 1.5 * kStep_s);
  // Both hands have returned to the idle clip, except for the balance of straight legs.
  const auto& track = run.record().tracks[0];
  for (const HumanBone hand : {HumanBone::kLeftHand, HumanBone::kRightHand}) {
    const glm::dvec3 is = joint_of(run, 0, hand, track.poses.back());
    const glm::dvec3 was = joint_of(run, 0, hand, track.references.back());
    EXPECT_LT(glm::distance(is, was), 5e-3);
  }
}

TEST(SceneRun, SolvesABodyAfterThatWhoseWristItHolds) {
  // The first body of the file depends on the second one.
  const SceneRun run = played(made_stage_input(
      "[[body]]\nid = \"red\"\nplace_m = [0.0, 0.5]\nheading_deg = 180.0\n" + kAnn +
      "[[target]]\nid = \"wrist\"\npath = \"body\"\nbody = \"ann\"\n"
      "segment = \"rightHand\"\n" +
      kWave +
      "[[at]]\ntime_s = 0.0\nbody = \"red\"\ndo = \"constrain\"\n"
      "segment = \"leftHand\"\ntarget = \"wrist\"\nfade_in_s = 0.2\n"));
  const auto& red = run.record().tracks[0];
  const auto& ann = run.record().tracks[1];
  double moved_m = 0.0;
  for (std::size_t step = 20; step < red.poses.size(); ++step) {
    const glm::dvec3 wrist = joint_of(run, 1, HumanBone::kRightHand, ann.poses[step]);
    const glm::dvec3 hand = joint_of(run, 0, HumanBone::kLeftHand, red.poses[step]);
    EXPECT_LT(glm::distance(wrist, hand), 1e-3) << "step " << step;
    moved_m = std::max(
        moved_m,
        glm::distance(wrist, joint_of(run, 1, HumanBone::kRightHand, ann.poses[19])));
  }
  EXPECT_GT(moved_m, 0.1);
}

TEST(SceneRun, KeepsFeetWhereTheyStandOnAFloorThatMoves) {
  SceneRunInput input = made_stage_input(kAnn + "hand_loads_kg = [5.0, 5.0]\n");
  FloorPart plate{.name = "plate",
                  .min_xz_m = {-3.0, -3.0},
                  .max_xz_m = {3.0, 3.0},
                  .height_m = 0.2,
                  .slope = {0.0, 0.1},
                  .path = {{0.5, glm::dvec3(0.0)}, {1.5, {0.4, 0.1, -0.3}}}};
  input.floor.parts.push_back(plate);
  const SceneRun run = played(std::move(input));
  const StageTrack& track = run.record().tracks[0];
  const glm::dvec3 stood =
      joint_of(run, 0, HumanBone::kLeftFoot, track.poses[0]) - track.floor_moved_m[0][0];
  for (std::size_t step = 0; step < track.poses.size(); ++step) {
    ASSERT_TRUE(track.stands[step][0]);
    const glm::dvec3 stands = joint_of(run, 0, HumanBone::kLeftFoot, track.poses[step]) -
                              track.floor_moved_m[step][0];
    EXPECT_LT(glm::distance(stands, stood), 1e-4) << "step " << step;
  }
  EXPECT_NEAR(track.floor_moved_m.back()[0].x, 0.4, 1e-6);
  EXPECT_NEAR(track.floor_moved_m.back()[1].z, -0.3, 1e-6);
}

TEST(SceneRun, LetsTargetsBeDraggedThatAreMarkedSo) {
  const auto text = [](const std::string& drag) {
    return kAnn +
           "[[target]]\nid = \"cup\"\npath = \"fixed\"\nposition_m = [0.3, 1.1, 0.4]\n" +
           drag +
           "[[at]]\ntime_s = 0.0\nbody = \"ann\"\ndo = \"constrain\"\n"
           "segment = \"leftHand\"\ntarget = \"cup\"\nfade_in_s = 0.1\n";
  };
  SceneRun fixed = *SceneRun::make(made_stage_input(text("")));
  EXPECT_FALSE(fixed.set_target(0, glm::dvec3(0.2, 1.0, 0.4)));
  SceneRun run = *SceneRun::make(made_stage_input(text("drag = true\n")));
  const glm::dvec3 held(0.25, 1.2, 0.35);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(run.set_target(0, glm::dvec3(nan, 1.0, 0.0)));
  EXPECT_TRUE(run.set_target(0, held));
  for (int step = 0; step < 60; ++step) run.advance();
  EXPECT_EQ(run.target_in_world(0, 0), held);
  const glm::dvec3 hand = joint_of(run, 0, HumanBone::kLeftHand, run.pose(0));
  EXPECT_LT(glm::distance(hand, held), 1e-3);
}

TEST(SceneRun, RefusesAnUnknownClipWithTheNearestName) {
  const std::string message = refusal_of(
      kAnn + "[[at]]\ntime_s = 0.0\nbody = \"ann\"\ndo = \"play\"\nclip = \"wavy\"\n");
  EXPECT_NE(message.find("wavy"), std::string::npos) << message;
  EXPECT_NE(message.find("\"wave\""), std::string::npos) << message;
}

TEST(SceneRun, RefusesAnIdleClipThatTheBaseDoesNotHave) {
  const std::string message = refusal_of(kAnn + "idle = \"sits\"\n");
  EXPECT_NE(message.find("sits"), std::string::npos) << message;
  EXPECT_NE(message.find("ann"), std::string::npos) << message;
}

TEST(SceneRun, RefusesASegmentThatTheBodyDoesNotHave) {
  const std::string message = refusal_of(
      kAnn +
      "[[target]]\nid = \"cup\"\npath = \"fixed\"\nposition_m = [0.3, 1.1, 0.4]\n"
      "[[at]]\ntime_s = 0.0\nbody = \"ann\"\ndo = \"constrain\"\n"
      "segment = \"leftWing\"\ntarget = \"cup\"\n");
  EXPECT_NE(message.find("leftWing"), std::string::npos) << message;
}

TEST(SceneRun, RefusesAnEndlessPlayOfAClipThatIsNoLoop) {
  const std::string message =
      refusal_of(kAnn +
                 "[[at]]\ntime_s = 0.0\nbody = \"ann\"\ndo = \"play\"\n"
                 "clip = \"wave\"\nloops = true\n");
  EXPECT_NE(message.find("wave"), std::string::npos) << message;
}

}  // namespace
}  // namespace marey::app::testing
