// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_motion.h"

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::app {
namespace {

constexpr int kFrames = 30;

/// A person at 30 frames a second whose left forearm turns to and fro by `turn_rad` and
/// whose root moves to and fro by `step_m` from each frame to the next.
ReportTrial quick(double turn_rad = 1.3, double step_m = 0.7) {
  ReportTrial trial;
  trial.name = "walk";
  trial.rate = FrameRate{30.0};
  trial.first_frame = 100;
  ReportBody& body = trial.bodies.emplace_back();
  body.motion.skeleton = make_humanoid(average_proportions(1.75));
  body.motion.rate = trial.rate;
  for (int f = 0; f < kFrames; ++f) {
    Pose pose = rest_pose(body.motion.skeleton);
    pose.parent_from_joint[index(HumanBone::kLeftLowerArm)] =
        rotation_from_vector(glm::dvec3(0.0, -turn_rad * (f % 2), 0.0));
    pose.root_in_world.x += step_m * (f % 2);
    body.motion.poses.push_back(pose);
    body.uncertainty.emplace_back(kHumanBoneCount,
                                  JointUncertainty{0.005, Source::kMeasured});
  }
  return trial;
}

void turn(ReportTrial& trial, HumanBone bone, std::size_t frame, double rad) {
  glm::dquat& rotation =
      trial.bodies[0].motion.poses[frame].parent_from_joint[index(bone)];
  rotation = rotation * rotation_from_vector(glm::dvec3(rad, 0.0, 0.0));
}

TEST(AssessMotion, LetsQuickMovementPass) {
  EXPECT_TRUE(assess_motion(quick()).empty()) << "39 rad/s, 21 m/s";
  EXPECT_TRUE(assess_motion(ReportTrial{}).empty());
}

TEST(AssessMotion, NamesMovementThatIsQuickerThanAnyBody) {
  const auto turning = assess_motion(quick(1.6, 0.0));
  ASSERT_EQ(turning.size(), 1U) << "48 rad/s";
  EXPECT_TRUE(
      turning[0].cause.starts_with("segment \"leftLowerArm\" turns by 92 degrees"))
      << turning[0].cause;
  EXPECT_NE(turning[0].cause.find("(28 other frames also)"), std::string::npos);
  EXPECT_EQ(assess_motion(quick(0.0, 0.9)).size(), 1U) << "27 m/s";
}

TEST(AssessMotion, NamesASegmentThatTurnsAboutInOneFrame) {
  ReportTrial trial = quick(0.3, 0.0);
  turn(trial, HumanBone::kRightHand, 12, 3.0);
  const auto found = assess_motion(trial);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].severity, Severity::kPoor);
  EXPECT_EQ(found[0].where, "trial walk");
  EXPECT_EQ(found[0].cause,
            "segment \"rightHand\" turns by 172 degrees between frames 111 and 112, "
            "faster than a body can move (1 other frame also)");
}

TEST(AssessMotion, NamesABodyThatLeaps) {
  ReportTrial trial = quick(0.0, 0.0);
  for (std::size_t f = 20; f < kFrames; ++f) {
    trial.bodies[0].motion.poses[f].root_in_world.x += 1.5;
  }
  const auto found = assess_motion(trial);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].cause.find("travels by 1500 mm between frames 119 and 120"),
            std::string::npos)
      << found[0].cause;
}

TEST(AssessMotion, IgnoresUnmeasuredFrames) {
  ReportTrial trial = quick(0.3, 0.0);
  turn(trial, HumanBone::kRightHand, 12, 3.0);
  trial.bodies[0].uncertainty[12][index(HumanBone::kRightHand)].source =
      Source::kInferred;
  EXPECT_TRUE(assess_motion(trial).empty());
}

}  // namespace
}  // namespace marey::app
