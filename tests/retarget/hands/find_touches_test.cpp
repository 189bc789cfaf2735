// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/find_touches.h"

#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/hands/touch_constraints.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

// As in adapter_bodies: residual noise of a good capture.
constexpr double kNoise_rad = 0.003;
constexpr double kNoise_m = 0.002;

Touches found(const Motion& motion) {
  const BodyMap map = mapped(motion.skeleton);
  return find_touches(motion, map, average_volume(motion.skeleton, map));
}

// Returns the one touch of that hand and part; fails the test if there is not exactly
// one.
Touch only(const Touches& touches, int side, P part) {
  Touch out;
  int count = 0;
  std::string all;
  for (const Touch& touch : touches.touches) {
    all += std::string(touch.side == 0 ? "left" : "right") + " on " +
           std::string(name(touch.part)) + " " + std::to_string(touch.frames.first) +
           ".." + std::to_string(touch.frames.last) + "; ";
    if (touch.side != side || touch.part != part) continue;
    out = touch;
    ++count;
  }
  EXPECT_EQ(count, 1) << all;
  return out;
}

void expect_held(const Touch& touch) {
  // The hand comes to rest during the last tenths of a second of its path.
  EXPECT_GT(touch.frames.first, kHeldFirst - 12);
  EXPECT_LE(touch.frames.first, kHeldFirst);
  EXPECT_GE(touch.frames.last, kHeldLast);
  EXPECT_LT(touch.frames.last, kHeldLast + 12);
}

class EveryNoise : public ::testing::TestWithParam<double> {
 protected:
  [[nodiscard]] Touches found_in(const HandPlaces& places) const {
    return found(hands_go_to(places, GetParam() * kNoise_rad, GetParam() * kNoise_m));
  }
};
INSTANTIATE_TEST_SUITE_P(FindTouches, EveryNoise, ::testing::Values(0.0, 1.0));

TEST_P(EveryNoise, FindsAClap) {
  const Touch touch = only(found_in(clapping()), 0, P::kRightHand);
  expect_held(touch);
  EXPECT_NEAR(touch.distance_m, 0.003, 0.003);
}

TEST_P(EveryNoise, FindsAHandOnTheHead) {
  const Touch touch = only(found_in(hand_on_head()), 0, P::kHead);
  expect_held(touch);
  EXPECT_GT(touch.place.along, 0.9);  // On top.
}

TEST_P(EveryNoise, FindsHandsOnTheHips) {
  const Touches touches = found_in(hands_on_hips());
  EXPECT_GT(only(touches, 0, P::kPelvis).place.along, 0.9);
  EXPECT_LT(only(touches, 1, P::kPelvis).place.along, -0.9);
  expect_held(only(touches, 0, P::kPelvis));
}

TEST_P(EveryNoise, FindsNothingInHandsThatHang) {
  const Touches touches = found_in({});
  EXPECT_TRUE(touches.touches.empty());
  EXPECT_TRUE(touches.still.empty());
}

// A hand that passes at 2 m/s does not touch, at any distance.
TEST(FindTouches, FindsNothingInAHandThatPassesBy) {
  Motion motion = hands_go_to(hand_on_head());
  const Pose there = motion.poses[120];
  motion.poses.assign(60, motion.poses[0]);
  for (std::size_t i = 29; i < 32; ++i) motion.poses[i] = there;
  EXPECT_TRUE(found(motion).touches.empty());
}

TEST(FindTouches, FindsNothingInNoMotion) {
  Motion motion = hands_go_to({});
  motion.poses.clear();
  EXPECT_TRUE(found(motion).touches.empty());
}

// A body that bows over a hand on a table.
TEST(FindTouches, FindsAHandThatLeans) {
  const Motion raised = hands_go_to(
      {HandPlace{{0.25, 1.0, 0.45}, glm::angleAxis(-1.5708, glm::dvec3(0, 1, 0))}, {}});
  Motion motion = raised;
  motion.poses.clear();
  const BodyMap map = mapped(raised.skeleton);
  const std::size_t hand = index(map.limbs[0]->end);
  const glm::dvec3 stays =
      world_from_joints(raised.skeleton, raised.poses[120])[hand].translation;
  for (int t = 0; t < 90; ++t) {
    // The arm's posture changes and the root compensates: the shoulder moves.
    Pose pose = raised.poses[120];
    const double angle = 0.006 * t;
    glm::dquat& shoulder = pose.parent_from_joint[index(map.limbs[0]->upper)];
    shoulder = glm::angleAxis(angle, glm::dvec3(1, 0, 0)) * shoulder;
    pose.root_in_world +=
        stays - world_from_joints(raised.skeleton, pose)[hand].translation;
    motion.poses.push_back(pose);
  }
  const Touches touches = found(motion);
  ASSERT_FALSE(touches.still.empty());
  EXPECT_EQ(touches.still[0].side, 0);
  EXPECT_GT(touches.still[0].frames.last - touches.still[0].frames.first, 24);
}

TEST(TouchConstraints, AreNamedTimedAndAtTheRightDistance) {
  const Motion motion = hands_go_to(hands_on_hips());
  const BodyMap map = mapped(motion.skeleton);
  const BodyVolume volume = average_volume(motion.skeleton, map);
  Touches touches = find_touches(motion, map, volume);
  touches.still.push_back({1, {10, 40}, {0.1, 0.9, 0.2}});
  TouchConstraintsOptions options;
  options.world = {0.5, 0.01};
  const ConstraintSet set =
      constraints_of(touches, motion.skeleton, map, volume, 60, motion.rate, options);
  const Constraint* hip = set.find("left hand on pelvis 1");
  ASSERT_NE(hip, nullptr);
  EXPECT_EQ(hip->point.segment, "leftHand");
  const auto& goal = std::get<DistanceToBody>(hip->goal);
  EXPECT_EQ(goal.other.segment, "hips");
  EXPECT_NEAR(goal.distance_m, volume[P::kLeftHand]->radius_m + 0.003, 0.003);
  const Touch touch = only(touches, 0, P::kPelvis);
  EXPECT_NEAR(*hip->activation.start_s, (60 + touch.frames.first) / 60.0 - 0.3, 1e-12);
  EXPECT_NEAR(*hip->activation.stop_s, (60 + touch.frames.last) / 60.0, 1e-12);
  const Constraint* still = set.find("right hand still 1");
  ASSERT_NE(still, nullptr);
  EXPECT_NEAR(std::get<DistanceToPoint>(still->goal).p_in_world.y, 0.46, 1e-12);
}

TEST(TouchConstraints, KeepHeightsOfTheSourceIfAsked) {
  const Skeleton body = adult();
  const BodyMap map = mapped(body);
  Touches touches;
  touches.frame_count = 60;
  touches.still.push_back({1, {0, 59}, {0.1, 0.9, 0.2}});
  TouchConstraintsOptions options;
  options.world = {0.5, 0.01};
  options.still = StillPlace::kKept;
  const BodyVolume volume = average_volume(body, map);
  const ConstraintSet set =
      constraints_of(touches, body, map, volume, 0, FrameRate{60.0}, options);
  ASSERT_EQ(set.constraints.size(), 1u);
  const auto y_m = [](const ConstraintSet& of) {
    return std::get<DistanceToPoint>(of.constraints[0].goal).p_in_world.y;
  };
  EXPECT_EQ(y_m(set), 0.9);
  // From the first frame to the last: it does not fade.
  EXPECT_FALSE(set.constraints[0].activation.start_s);
  EXPECT_FALSE(set.constraints[0].activation.stop_s);
  // Over the floor, at any height of the source's.
  options.world.source_floor_m = 0.5;
  const auto on_floor = [&] {
    return constraints_of(touches, body, map, volume, 0, FrameRate{60.0}, options);
  };
  EXPECT_EQ(y_m(on_floor()), 0.4);
  options.still = StillPlace::kScaled;
  options.world.keeps_heights = true;
  EXPECT_EQ(y_m(on_floor()), 0.4);
}

}  // namespace
}  // namespace marey::retarget
