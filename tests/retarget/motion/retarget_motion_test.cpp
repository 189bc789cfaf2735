// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/retarget_motion.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/pose.h"
#include "tests/retarget/joint_path.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/paths.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/truth_motion.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

std::string truth_file(const std::string& session) {
  return marey::testing::shared_data().string() + "/blender/dev/" + session +
         "/truth/segments.csv";
}

RetargetedMotion retargeted(const Motion& source,
                            const Skeleton& avatar,
                            const RetargetOptions& options = {}) {
  Result<RetargetedMotion> out = retarget_motion(source, avatar, options);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

double max_acceleration(const Motion& motion, B bone) {
  const auto p = joint_path(motion, bone);
  double greatest = 0.0;
  for (std::size_t t = 1; t + 1 < p.size(); ++t) {
    greatest = std::max(greatest, glm::length(p[t - 1] - 2.0 * p[t] + p[t + 1]));
  }
  return greatest * motion.rate.hz * motion.rate.hz;
}

struct Avatar {
  const char* name;
  std::function<Skeleton()> make;
};

class EveryAvatar : public ::testing::TestWithParam<Avatar> {};

INSTANTIATE_TEST_SUITE_P(
    RetargetMotion,
    EveryAvatar,
    ::testing::Values(Avatar{"Child", testing::child},
                      Avatar{"Giant", testing::giant},
                      Avatar{"LongLegs", testing::long_legs},
                      Avatar{"APose",
                             [] {
                               testing::Dice dice(3);
                               return testing::with_random_axes(
                                   testing::in_a_pose(testing::child(), 0.8), dice);
                             }},
                      Avatar{"NoToesSevenVertebrae",
                             [] {
                               const Skeleton s =
                                   testing::with_vertebrae(testing::giant(), 7);
                               return testing::without(testing::without(s, B::kLeftToes),
                                                       B::kRightToes);
                             }}),
    [](const auto& case_info) { return std::string(case_info.param.name); });

TEST_P(EveryAvatar, WalksWithoutSliding) {
  const auto out = retargeted(testing::synthetic_walk(200, 60.0, 0.002, 0.001).motion,
                              GetParam().make());
  EXPECT_GT(out.report.before.mean_slide_cm_per_s, 0.5);
  EXPECT_LT(out.report.after.mean_slide_cm_per_s, 1e-6);
  EXPECT_EQ(out.report.ground.unreachable_frames, 0);
}

TEST_P(EveryAvatar, KeepsItsFeetOutOfTheFloor) {
  Motion source = testing::synthetic_walk(200, 60.0).motion;
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    // A capture that occasionally sinks into its floor.
    source.poses[t].root_in_world.y -= 0.02 * std::sin(0.1 * static_cast<double>(t));
  }
  const auto out = retargeted(source, GetParam().make());
  EXPECT_LT(out.report.after.max_penetration_mm, 1e-6);
}

// Flat is flat: both joints of a foot that bears on heel and ball are where they are
// when the avatar stands in its T-pose.
TEST_P(EveryAvatar, StandsOnItsOwnSoles) {
  const testing::SyntheticWalk walk = testing::synthetic_walk(200, 60.0);
  const Skeleton avatar = GetParam().make();
  const auto out = retargeted(walk.motion, avatar);
  const BodyMap map = *map_body(avatar);
  const auto ankle = joint_path(out.motion, B::kLeftFoot);
  for (const FrameRange& run : out.report.contacts.feet[0].heel) {
    for (int t = run.first; t <= run.last; ++t) {
      EXPECT_NEAR(ankle[static_cast<std::size_t>(t)].y, map.feet[0].ankle_height_m, 1e-9);
    }
  }
}

// Holding and releasing the feet has a cost; a jump of one centimetre in one frame at 60
// Hz would be 36 m/s^2, as much as the whole swing.
TEST_P(EveryAvatar, MovesItsFeetHardlyMoreSuddenlyThanTheSource) {
  const Motion source = testing::synthetic_walk(200, 60.0).motion;
  const Skeleton avatar = GetParam().make();
  const double scale =
      map_body(avatar)->leg_length_m / map_body(source.skeleton)->leg_length_m;
  const auto out = retargeted(source, avatar);
  for (const B foot : {B::kLeftFoot, B::kRightFoot}) {
    EXPECT_LT(max_acceleration(out.motion, foot),
              1.5 * scale * max_acceleration(source, foot));
  }
  EXPECT_LT(max_acceleration(out.motion, B::kHips),
            1.25 * scale * max_acceleration(source, B::kHips));
}

TEST_P(EveryAvatar, WalksACapturedWalkWithoutSlidingOrSinking) {
  const auto source = testing::truth_motion(truth_file("walk"));
  if (!source) GTEST_SKIP() << "no recording at " << truth_file("walk");
  const auto out = retargeted(*source, GetParam().make());
  EXPECT_LT(out.report.after.mean_slide_cm_per_s, 0.5);
  EXPECT_LT(out.report.after.max_penetration_mm, 1.0);
  EXPECT_EQ(out.report.ground.unreachable_frames, 0);
}

// At 30 Hz a captured footfall takes two frames; pinning it takes one.
TEST_P(EveryAvatar, WalksACapturedWalkWithoutJumps) {
  const auto source = testing::truth_motion(truth_file("walk"));
  if (!source) GTEST_SKIP() << "no recording at " << truth_file("walk");
  const Skeleton avatar = GetParam().make();
  const double scale =
      map_body(avatar)->leg_length_m / map_body(source->skeleton)->leg_length_m;
  const auto out = retargeted(*source, avatar);
  for (const B foot : {B::kLeftFoot, B::kRightFoot}) {
    EXPECT_LT(max_acceleration(out.motion, foot),
              1.5 * scale * max_acceleration(*source, foot));
  }
  EXPECT_LT(max_acceleration(out.motion, B::kHips),
            1.25 * scale * max_acceleration(*source, B::kHips));
}

TEST_P(EveryAvatar, LandsACapturedJumpWithoutSlidingOrSinking) {
  const auto source = testing::truth_motion(truth_file("jump"));
  if (!source) GTEST_SKIP() << "no recording at " << truth_file("jump");
  const auto out = retargeted(*source, GetParam().make());
  EXPECT_LT(out.report.after.mean_slide_cm_per_s, 0.5);
  EXPECT_LT(out.report.after.max_penetration_mm, 1.0);
}

// While no foot bears, ground adaptation does not change the root's path.
TEST_P(EveryAvatar, FliesAsHighAsTheSourceInLegLengths) {
  const auto source = testing::truth_motion(truth_file("jump"));
  if (!source) GTEST_SKIP() << "no recording at " << truth_file("jump");
  const Skeleton avatar = GetParam().make();
  const double scale =
      map_body(avatar)->leg_length_m / map_body(source->skeleton)->leg_length_m;
  const auto before = joint_path(*source, B::kHips);
  const auto after = joint_path(retargeted(*source, avatar).motion, B::kHips);
  // The middle of the flight: 62 is the take-off, 77 the landing.
  for (std::size_t t = 69; t <= 71; ++t) {
    EXPECT_NEAR(after[t].y - after[68].y, scale * (before[t].y - before[68].y), 1e-9);
  }
}

// Hips and ankles that lie higher or lower on the avatar do not bend or stretch its legs.
TEST_P(EveryAvatar, BendsItsKneesInStandingAsTheSourceDoes) {
  Motion source;
  source.skeleton = testing::long_legs();
  source.rate.hz = 30.0;
  const BodyMap from = *map_body(source.skeleton);
  NormalizedPose crouch = normalize(source.skeleton, from, rest_pose(source.skeleton));
  for (std::size_t leg : {2U, 3U}) {
    crouch.root.y -= 0.5 * (crouch.limbs[leg]->extension - 0.9);
    crouch.limbs[leg]->extension = 0.9;
  }
  source.poses.assign(30, expand(crouch, source.skeleton, from));
  const Skeleton avatar = GetParam().make();
  const auto out = retargeted(source, avatar);
  const NormalizedPose got = normalize(avatar, *map_body(avatar), out.motion.poses[15]);
  EXPECT_NEAR(got.limbs[2]->extension, 0.9, 2e-3);
  EXPECT_NEAR(got.limbs[3]->extension, 0.9, 2e-3);
}

// On its own body a clean walk hardly changes: two centimetres at the ankle, from holding
// still a foot that has begun to leave.
TEST(RetargetMotion, LeavesACleanWalkOnItsOwnBodyNearlyAsItIs) {
  const Motion source = testing::synthetic_walk(200, 60.0).motion;
  const auto out = retargeted(source, source.skeleton);
  for (const B bone : {B::kHips, B::kLeftHand, B::kRightFoot, B::kHead}) {
    const auto before = joint_path(source, bone);
    const auto after = joint_path(out.motion, bone);
    for (std::size_t t = 0; t < before.size(); ++t) {
      ASSERT_LT(glm::distance(before[t], after[t]), 0.02) << name(bone) << " " << t;
    }
  }
}

TEST(RetargetMotion, CopiesThePostureExactlyWithoutGroundAdaptation) {
  const Motion source = testing::synthetic_walk(60, 60.0).motion;
  RetargetOptions options;
  options.adapt_ground = false;
  const auto out = retargeted(source, source.skeleton, options);
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    const auto before = world_from_joints(source.skeleton, source.poses[t]);
    const auto after = world_from_joints(source.skeleton, out.motion.poses[t]);
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_LT(glm::distance(before[i].translation, after[i].translation), 1e-6);
    }
  }
}

TEST(RetargetMotion, GivesTheSameBytesTwice) {
  const Motion source = testing::synthetic_walk(90, 60.0, 0.003, 0.002).motion;
  const auto a = retargeted(source, testing::giant());
  const auto b = retargeted(source, testing::giant());
  ASSERT_EQ(a.motion.poses.size(), b.motion.poses.size());
  for (std::size_t t = 0; t < a.motion.poses.size(); ++t) {
    const auto& qa = a.motion.poses[t].parent_from_joint;
    const auto& qb = b.motion.poses[t].parent_from_joint;
    ASSERT_EQ(std::memcmp(qa.data(), qb.data(), qa.size() * sizeof(qa[0])), 0);
  }
}

TEST(RetargetMotion, KeepsRateAndFrameNumbers) {
  Motion source = testing::synthetic_walk(30, 60.0).motion;
  source.first_frame = 7;
  const auto out = retargeted(source, testing::child());
  EXPECT_EQ(out.motion.first_frame, 7);
  EXPECT_EQ(out.motion.rate.hz, 60.0);
  EXPECT_EQ(out.motion.poses.size(), 30U);
}

TEST(RetargetMotion, NamesTheAvatarWhenItHasNoLegs) {
  const Motion source = testing::synthetic_walk(5, 60.0).motion;
  const auto out =
      retarget_motion(source, testing::without(testing::child(), B::kRightFoot));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().message(),
            "avatar: no joint is marked rightFoot. Next: map the bone to one of the "
            "skeleton's joints.");
}

TEST(RetargetMotion, DeclinesArmLengthsOfABodyWithoutArms) {
  const Motion source = testing::synthetic_walk(5, 60.0).motion;
  Skeleton avatar = testing::without(testing::child(), B::kRightHand);
  avatar = testing::without(avatar, B::kLeftHand);
  RetargetOptions options;
  options.root = RootNormalization::kArmLength;
  const auto out = retarget_motion(source, avatar, options);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().where, "avatar");
}

TEST(RetargetMotion, AcceptsAMotionWithoutFrames) {
  Motion source;
  source.skeleton = testing::giant();
  EXPECT_TRUE(retargeted(source, testing::child()).motion.poses.empty());
}

// The ground figures distinguish a bad motion from a good one.
TEST(MeasureFeet, SeesAFootThatSlidesAndSinks) {
  Motion motion;
  motion.skeleton = testing::giant();
  motion.rate.hz = 50.0;
  const BodyMap map = *map_body(motion.skeleton);
  for (int t = 0; t < 10; ++t) {
    Pose pose = rest_pose(motion.skeleton);
    pose.root_in_world += glm::dvec3(0.002 * t, -0.005, 0);
    motion.poses.push_back(pose);
  }
  Contacts contacts;
  contacts.frame_count = 10;
  contacts.feet[0].heel = {{0, 9}};
  const FootFigures figures = measure_feet(motion, map, contacts);
  EXPECT_NEAR(figures.mean_slide_cm_per_s, 10.0, 1e-9);
  EXPECT_NEAR(figures.max_penetration_mm, 5.0, 1e-9);
}

// On tiptoe about its toe tips, heels high: the tips alone are in the floor.
TEST(MeasureFeet, SeesTheTipOfAFootWithoutAToeJoint) {
  const Skeleton toeless =
      testing::without(testing::without(testing::giant(), B::kLeftToes), B::kRightToes);
  Motion motion{toeless, {50.0}, 0, {rest_pose(toeless)}};
  const BodyMap map = *map_body(toeless);
  const JointIndex ankle = map.leg(0).end;
  constexpr double kPitch_rad = 0.5;
  const auto rest = world_from_joints(toeless, motion.poses[0]);
  const glm::dquat pitch = glm::angleAxis(kPitch_rad, glm::dvec3(1, 0, 0));
  glm::dquat& turn = motion.poses[0].parent_from_joint[index(ankle)];
  const glm::dquat world = rest[index(ankle)].rotation;
  turn = turn * glm::conjugate(world) * pitch * world;
  const FootMap& foot = map.feet[0];
  const glm::dvec3 tip = foot.ball_from_ankle_in_t_pose + foot.tip_from_ball_in_t_pose;
  const double under_m = -(rest[index(ankle)].translation + pitch * tip).y;
  ASSERT_GT(under_m, 0.05);
  Contacts contacts;
  contacts.frame_count = 1;
  EXPECT_NEAR(
      measure_feet(motion, map, contacts).max_penetration_mm, 1e3 * under_m, 1e-6);
}

}  // namespace
}  // namespace marey::retarget
