// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/keep_heights.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/balance_scenes.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

RetargetedMotion put_on(const Motion& source,
                        const Skeleton& avatar,
                        WorldLengths path,
                        WorldLengths heights) {
  RetargetOptions options;
  options.path = path;
  options.heights = heights;
  options.hands.emplace();
  auto out = retarget_motion(source, avatar, options);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

glm::dvec3 place(const Motion& motion, int frame, B bone) {
  const auto world =
      world_from_joints(motion.skeleton, motion.poses[static_cast<std::size_t>(frame)]);
  return world[index(*motion.skeleton.find(bone))].translation;
}

constexpr auto kScaled = WorldLengths::kScaled;
constexpr auto kKept = WorldLengths::kKept;
constexpr int kHeld = (kPostureFirst + kPostureLast) / 2;

TEST(KeptHipsHeight, RisesSmoothlyWithTheSourceFromSittingToJumping) {
  for (const double stands_m : {0.15, 0.4, 0.7, 0.95, 1.3, 2.4}) {
    constexpr double kSource_m = 0.95;
    const auto at = [&](double y_m) {
      return kept_hips_height_m(y_m, kSource_m, stands_m);
    };
    EXPECT_EQ(at(0.04), 0.04);
    EXPECT_NEAR(at(kSource_m), stands_m, 1e-12);
    EXPECT_NEAR(at(kSource_m + 0.3), stands_m + 0.3, 1e-12);
    constexpr double kStep_m = 1e-4;
    double slope_before = 1.0;
    for (double y_m = 0.0; y_m < 1.5; y_m += kStep_m) {
      const double slope = (at(y_m + kStep_m) - at(y_m)) / kStep_m;
      EXPECT_GT(slope, 0.0) << y_m;
      // A body of a sixth of the size has slopes below 1 at the ends.
      if (stands_m > 0.35) {
        EXPECT_NEAR(slope, slope_before, 0.01) << y_m;
      }
      slope_before = slope;
    }
  }
}

TEST(KeptHeights, AKickIsAsHighInMetresOnABodyOfAnySize) {
  const Motion source = slow_kick();
  const double rests_m = place(source, 0, B::kRightFoot).y;
  const double high_m = place(source, kHeld, B::kRightFoot).y - rests_m;
  ASSERT_GT(high_m, 0.8);
  for (const Skeleton& avatar : {testing::child(), testing::giant()}) {
    const double ankle_m = map_body(avatar)->feet[1].ankle_height_m;
    const auto scaled = put_on(source, avatar, kScaled, kScaled);
    const auto kept = put_on(source, avatar, kScaled, kKept);
    EXPECT_GT(std::abs(place(scaled.motion, kHeld, B::kRightFoot).y - ankle_m - high_m),
              0.2);
    EXPECT_NEAR(place(kept.motion, kHeld, B::kRightFoot).y - ankle_m, high_m, 2e-3);
    // Standing feet stay in place.
    EXPECT_LT(kept.report.after.mean_slide_cm_per_s, 1e-6);
    EXPECT_LT(kept.report.after.max_penetration_mm, 1e-6);
    EXPECT_EQ(kept.report.ground.unreachable_frames, 0);
  }
}

TEST(KeptHeights, AJumpIsAsHighInMetres) {
  const Motion source = small_jump(0.3);
  const int apex = static_cast<int>(source.poses.size()) / 2;
  for (const Skeleton& avatar : {testing::child(), testing::giant()}) {
    const auto rise_m = [&](WorldLengths heights) {
      const Motion made = put_on(source, avatar, kScaled, heights).motion;
      return place(made, apex, B::kHips).y - place(made, 0, B::kHips).y;
    };
    EXPECT_NEAR(rise_m(kKept), 0.3, 1e-3);
    EXPECT_GT(std::abs(rise_m(kScaled) - 0.3), 0.05);
  }
}

// Arms reach forward horizontally: their targets are as high as the source's shoulders.
TEST(KeptHeights, AHandReachesAsHighInMetresAsFarAsTheArmGoes) {
  HandPlaces places;
  const Skeleton body = adult();
  const auto rest = world_from_joints(body, rest_pose(body));
  const double shoulder_m = rest[index(*body.find(B::kRightUpperArm))].translation.y;
  HandPlace right;
  right.middle_in_world = {-0.25, shoulder_m - 0.15, 0.55};
  places[1] = right;
  const Motion source = hands_go_to(places);
  const int held = (kHeldFirst + kHeldLast) / 2;
  const double high_m = place(source, held, B::kRightHand).y;
  const Skeleton giant = testing::giant();
  EXPECT_GT(
      std::abs(
          place(put_on(source, giant, kScaled, kScaled).motion, held, B::kRightHand).y -
          high_m),
      0.2);
  EXPECT_NEAR(place(put_on(source, giant, kScaled, kKept).motion, held, B::kRightHand).y,
              high_m,
              5e-3);
}

// A source on another floor: centred on its hips, or on a platform.
Motion raised(Motion motion, double by_m) {
  for (Pose& pose : motion.poses) pose.root_in_world.y += by_m;
  return motion;
}

// In place, with the right hand forward at shoulder height, 90 to 150.
Motion reach() {
  HandPlaces places;
  places[1] = HandPlace{{-0.25, 1.25, 0.55}};
  return hands_go_to(places);
}

TEST(KeptHeights, AreOverTheFloorThatTheSourceStandsOn) {
  for (const Motion& source : {slow_kick(), small_jump(0.3), deep_bend(), reach()}) {
    for (const Skeleton& avatar : {testing::child(), testing::giant()}) {
      const Motion level = put_on(source, avatar, kScaled, kKept).motion;
      for (const double floor_m : {-1.5, 0.5}) {
        const Motion other =
            put_on(raised(source, floor_m), avatar, kScaled, kKept).motion;
        for (int t = 0; t < static_cast<int>(source.poses.size()); ++t) {
          for (const B bone :
               {B::kHips, B::kHead, B::kLeftHand, B::kRightHand, B::kRightFoot}) {
            EXPECT_LT(glm::length(place(level, t, bone) - place(other, t, bone)), 1e-6)
                << floor_m << " " << t << " " << name(bone);
          }
        }
      }
    }
  }
}

// One foot alone defines the height of the floor.
TEST(KeptHeights, AreOverTheFloorOfAFootThatStandsAlone) {
  Motion source = slow_kick();
  source.poses.assign(120, source.poses[kHeld]);
  const Skeleton avatar = testing::giant();
  const auto level = put_on(source, avatar, kScaled, kKept);
  ASSERT_TRUE(level.report.contacts.feet[1].stance.empty());
  for (const double floor_m : {-1.5, 0.5}) {
    const Motion other = put_on(raised(source, floor_m), avatar, kScaled, kKept).motion;
    for (const B bone : {B::kHips, B::kRightHand, B::kRightFoot}) {
      EXPECT_LT(glm::length(place(level.motion, 60, bone) - place(other, 60, bone)), 1e-6)
          << floor_m << " " << name(bone);
    }
  }
}

// A body whose feet are not moved to Y = 0 stays on the source's floor, at any height.
TEST(KeptHeights, StayOnTheSourcesFloorWithoutTheGround) {
  RetargetOptions options;
  options.heights = kKept;
  options.adapt_ground = false;
  options.hands.emplace();
  for (const Motion& source : {slow_kick(), reach()}) {
    const auto level = *retarget_motion(source, testing::giant(), options);
    for (const double floor_m : {-1.5, 0.5}) {
      const auto other =
          *retarget_motion(raised(source, floor_m), testing::giant(), options);
      for (const B bone : {B::kHips, B::kRightHand, B::kRightFoot}) {
        EXPECT_NEAR(place(other.motion, kHeld, bone).y - floor_m,
                    place(level.motion, kHeld, bone).y,
                    1e-6)
            << floor_m << " " << name(bone);
      }
    }
  }
}

TEST(KeptHipsHeight, RisesWithHipsThatAreNotAboveTheFloorInStanding) {
  EXPECT_EQ(kept_hips_height_m(0.25, 0.0, 0.5), 0.75);
  EXPECT_EQ(kept_hips_height_m(-0.25, -0.5, 1.0), 1.25);
}

TEST(KeptPath, IsTheSourcesInMetresAndFeetStandStill) {
  const Motion source = testing::synthetic_walk(200, 60.0).motion;
  const Skeleton small = make_humanoid(average_proportions(1.5));
  const auto kept = put_on(source, small, kKept, kScaled);
  for (const int t : {0, 60, 199}) {
    const glm::dvec3 is = place(kept.motion, t, B::kHips);
    const glm::dvec3 was = place(source, t, B::kHips);
    EXPECT_NEAR(is.x, was.x, 1e-9);
    EXPECT_NEAR(is.z, was.z, 1e-9);
  }
  EXPECT_LT(kept.report.after.mean_slide_cm_per_s, 1e-6);
  EXPECT_EQ(kept.report.ground.unreachable_frames, 0);
}

TEST(KeptPathAndHeights, LeaveABodyThatIsTheSourcesAsItIs) {
  for (const Motion& source :
       {slow_kick(), small_jump(0.3), testing::synthetic_walk(200, 60.0).motion}) {
    const Motion scaled = put_on(source, source.skeleton, kScaled, kScaled).motion;
    const Motion kept = put_on(source, source.skeleton, kKept, kKept).motion;
    for (int t = 0; t < static_cast<int>(source.poses.size()); ++t) {
      for (const B bone : {B::kHips, B::kHead, B::kRightHand, B::kRightFoot}) {
        EXPECT_LT(glm::length(place(scaled, t, bone) - place(kept, t, bone)), 1e-4)
            << t << " " << name(bone);
      }
    }
  }
}

}  // namespace
}  // namespace marey::retarget
