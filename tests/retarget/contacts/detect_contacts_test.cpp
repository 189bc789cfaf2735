// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/detect_contacts.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/frame_range.h"
#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

std::vector<FrameRange> runs_of(const std::vector<char>& on) {
  std::vector<FrameRange> out;
  for (int t = 0; t < static_cast<int>(on.size()); ++t) {
    if (!on[static_cast<std::size_t>(t)]) continue;
    if (out.empty() || out.back().last != t - 1) out.push_back({t, t});
    out.back().last = t;
  }
  return out;
}

// Same contacts, each end within `frames`. Ends at the motion's own ends count too.
void expect_near(const std::vector<FrameRange>& found,
                 const std::vector<FrameRange>& truth,
                 int frames) {
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LE(std::abs(found[i].first - truth[i].first), frames) << "contact " << i;
    EXPECT_LE(std::abs(found[i].last - truth[i].last), frames) << "contact " << i;
  }
}

void expect_truth(const testing::SyntheticWalk& walk, int frames) {
  const BodyMap map = *map_body(walk.motion.skeleton);
  const Contacts contacts = detect_contacts(walk.motion, map);
  for (std::size_t side = 0; side < 2; ++side) {
    expect_near(contacts.feet[side].heel, runs_of(walk.feet[side].heel), frames);
    expect_near(contacts.feet[side].ball, runs_of(walk.feet[side].ball), frames);
  }
}

// The speed of a foot is continuous at the ends of a swing, so the very first and last
// slow frames look like rest: 50 ms.
TEST(DetectContacts, FindsEveryStepOfAWalkWithin50ms) {
  expect_truth(testing::synthetic_walk(190, 60.0), 3);
}

// Noise of 2 mm and 3 mrad per joint, as in a good capture; 67 ms.
TEST(DetectContacts, FindsEveryStepOfANoisyWalkWithin67ms) {
  expect_truth(testing::synthetic_walk(190, 60.0, 0.003, 0.002), 4);
}

TEST(DetectContacts, FindsTheSameStepsAt120Hz) {
  expect_truth(testing::synthetic_walk(380, 120.0), 7);
}

TEST(DetectContacts, DoesNotMindAFloorThatIsThreeCentimetresOff) {
  testing::SyntheticWalk walk = testing::synthetic_walk(190, 60.0);
  for (Pose& pose : walk.motion.poses) pose.root_in_world.y += 0.03;
  expect_truth(walk, 3);
}

TEST(DetectContacts, KnowsHowHighTheAnkleRests) {
  const testing::SyntheticWalk walk = testing::synthetic_walk(190, 60.0);
  const BodyMap map = *map_body(walk.motion.skeleton);
  const Contacts contacts = detect_contacts(walk.motion, map);
  EXPECT_NEAR(contacts.feet[0].ankle_height_m, map.feet[0].ankle_height_m, 1e-3);
  EXPECT_NEAR(contacts.feet[1].ball_height_m, map.feet[1].ball_height_m, 1e-3);
}

TEST(DetectContacts, FindsNoneInFreeFall) {
  Motion motion;
  motion.skeleton = testing::giant();
  motion.rate.hz = 60.0;
  for (int t = 0; t < 40; ++t) {
    Pose pose = rest_pose(motion.skeleton);
    const double s = t / 60.0;
    pose.root_in_world.y += 3.0 + 2.0 * s - 4.905 * s * s;
    pose.root_in_world.z += 1.5 * s;
    motion.poses.push_back(pose);
  }
  const Contacts contacts = detect_contacts(motion, *map_body(motion.skeleton));
  EXPECT_TRUE(contacts.feet[0].stance.empty());
  EXPECT_TRUE(contacts.feet[1].stance.empty());
}

TEST(DetectContacts, CallsAStillButRaisedFootNoContact) {
  Motion motion;
  motion.skeleton = testing::child();
  motion.rate.hz = 30.0;
  const BodyMap map = *map_body(motion.skeleton);
  Pose pose = rest_pose(motion.skeleton);
  // Standing on the right leg, the left knee up.
  pose.parent_from_joint[index(map.leg(0).upper)] =
      glm::angleAxis(-1.0, glm::dvec3(1, 0, 0));
  pose.parent_from_joint[index(map.leg(0).lower)] =
      glm::angleAxis(1.5, glm::dvec3(1, 0, 0));
  motion.poses.assign(30, pose);
  const Contacts contacts = detect_contacts(motion, map);
  EXPECT_TRUE(contacts.feet[0].stance.empty());
  EXPECT_EQ(contacts.feet[1].stance.size(), 1U);
}

// Bodies fitted to markers rise and sink by some centimetres from step to step.
TEST(DetectContacts, DoesNotMindAFloorThatRisesByFourCentimetresUnderway) {
  testing::SyntheticWalk walk = testing::synthetic_walk(190, 60.0);
  const double end_m = walk.motion.poses.back().root_in_world.z;
  for (Pose& pose : walk.motion.poses) {
    pose.root_in_world.y += 0.04 * pose.root_in_world.z / end_m;
  }
  expect_truth(walk, 4);
}

TEST(DetectContacts, BeginsWithTheFrameInWhichAFootHasLanded) {
  Motion motion;
  motion.skeleton = testing::child();
  motion.rate.hz = 30.0;
  const Pose stands = rest_pose(motion.skeleton);
  for (int t = 0; t < 40; ++t) {
    Pose pose = stands;
    pose.root_in_world.z += 0.08 * std::min(0, t - 15) + 0.08 * std::max(0, t - 25);
    motion.poses.push_back(pose);
  }
  const Contacts contacts = detect_contacts(motion, *map_body(motion.skeleton));
  for (const FootContacts& foot : contacts.feet) {
    ASSERT_EQ(foot.stance.size(), 1U);
    EXPECT_EQ(foot.stance[0].first, 15);
    EXPECT_EQ(foot.stance[0].last, 25);
  }
}

// Flat for a second, then on the balls of the feet for another, heels up by 20 degrees.
TEST(DetectContacts, DistinguishesARaisedStillHeelFromARestingHeel) {
  Motion motion;
  motion.skeleton = testing::giant();
  motion.rate.hz = 60.0;
  const BodyMap map = *map_body(motion.skeleton);
  for (int t = 0; t < 120; ++t) {
    Pose pose = rest_pose(motion.skeleton);
    const double up_rad = 0.35 * std::clamp((t - 60) / 12.0, 0.0, 1.0);
    const glm::dquat pitch = glm::angleAxis(up_rad, glm::dvec3(1, 0, 0));
    for (std::size_t side = 0; side < 2; ++side) {
      const JointIndex ankle = map.leg(static_cast<int>(side)).end;
      const JointIndex toes =
          *map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      pose.parent_from_joint[index(ankle)] = pitch * pose.parent_from_joint[index(ankle)];
      pose.parent_from_joint[index(toes)] =
          glm::conjugate(pitch) * pose.parent_from_joint[index(toes)];
    }
    const glm::dvec3 ball = map.feet[0].ball_from_ankle_in_t_pose;
    pose.root_in_world += ball - pitch * ball;
    motion.poses.push_back(pose);
  }
  const Contacts contacts = detect_contacts(motion, map);
  for (const FootContacts& foot : contacts.feet) {
    ASSERT_EQ(foot.ball.size(), 1U);
    EXPECT_EQ(foot.ball[0].last, 119);
    ASSERT_EQ(foot.heel.size(), 1U);
    EXPECT_LT(foot.heel[0].last, 72);
    ASSERT_FALSE(foot.heel_up.empty());
    EXPECT_LE(foot.heel_up.back().first, 74);
    EXPECT_EQ(foot.heel_up.back().last, 119);
  }
}

TEST(DetectContacts, AcceptsAMotionWithoutFrames) {
  Motion motion;
  motion.skeleton = testing::child();
  EXPECT_EQ(detect_contacts(motion, *map_body(motion.skeleton)).frame_count, 0);
}

}  // namespace
}  // namespace marey::retarget
