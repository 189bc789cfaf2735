// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_motion.h"

#include <gtest/gtest.h>

#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::app {
namespace {

constexpr int kFrames = 30;

/// Somebody at 30 frames a second whose left forearm turns by 20 degrees a frame, which
/// is quick, from frame 100 on.
ReportTrial quick() {
  ReportTrial trial;
  trial.name = "walk";
  trial.rate = FrameRate{30.0};
  trial.first_frame = 100;
  ReportBody& body = trial.bodies.emplace_back();
  body.motion.skeleton = make_humanoid(average_proportions(1.75));
  body.motion.rate = trial.rate;
  for (int f = 0; f < kFrames; ++f) {
    Pose pose = rest_pose(body.motion.skeleton);
    pose.parent_from_joint[index(HumanBone::kLeftLowerArm)] = rotation_from_vector(
        glm::dvec3(0.0, -0.35 * (f % 4 < 2 ? f % 2 : 1 - f % 2), 0.0));
    body.motion.poses.push_back(pose);
    body.doubt.emplace_back(kHumanBoneCount, JointDoubt{0.005, Source::kMeasured});
  }
  return trial;
}

void turn(ReportTrial& trial, HumanBone bone, std::size_t frame, double rad) {
  glm::dquat& rotation =
      trial.bodies[0].motion.poses[frame].parent_from_joint[index(bone)];
  rotation = rotation * rotation_from_vector(glm::dvec3(rad, 0.0, 0.0));
}

TEST(JudgeMotion, LetsQuickMovementPass) {
  EXPECT_TRUE(judge_motion(quick()).empty());
  EXPECT_TRUE(judge_motion(ReportTrial{}).empty());
}

TEST(JudgeMotion, NamesASegmentThatTurnsAboutInOneFrame) {
  ReportTrial trial = quick();
  turn(trial, HumanBone::kRightHand, 12, 3.0);
  const auto found = judge_motion(trial);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].code, Errc::kQuality);
  EXPECT_EQ(found[0].where, "trial walk");
  EXPECT_EQ(found[0].cause,
            "segment \"rightHand\" turns by 172 degrees between frames 111 and 112, "
            "faster than a body can (and 1 more such steps)");
}

TEST(JudgeMotion, NamesABodyThatLeaps) {
  ReportTrial trial = quick();
  for (std::size_t f = 20; f < kFrames; ++f) {
    trial.bodies[0].motion.poses[f].root_in_world.x += 1.5;
  }
  const auto found = judge_motion(trial);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].cause.find("travels by 1500 mm between frames 119 and 120"),
            std::string::npos)
      << found[0].cause;
}

TEST(JudgeMotion, SaysNothingOfWhatNobodySaw) {
  ReportTrial trial = quick();
  turn(trial, HumanBone::kRightHand, 12, 3.0);
  trial.bodies[0].doubt[12][index(HumanBone::kRightHand)].source = Source::kInferred;
  EXPECT_TRUE(judge_motion(trial).empty());
}

}  // namespace
}  // namespace marey::app
