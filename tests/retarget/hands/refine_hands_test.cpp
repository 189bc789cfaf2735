// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/refine_hands.h"

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/hand_scenes.h"
#include "tests/retarget/joint_path.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

struct Avatar {
  const char* name;
  std::function<Skeleton()> make;
};

struct RefinedScene {
  const char* name;
  HandPlaces (*places)();
  int side;
  P part;
};

class EveryBodyAndTouch
    : public ::testing::TestWithParam<std::tuple<Avatar, RefinedScene>> {};

Skeleton long_arms() {
  Proportions p = average_proportions(1.75);
  for (const B bone :
       {B::kLeftLowerArm, B::kLeftHand, B::kRightLowerArm, B::kRightHand}) {
    p[bone] *= 1.3;
  }
  return make_humanoid(p);
}

INSTANTIATE_TEST_SUITE_P(
    RefineHands,
    EveryBodyAndTouch,
    ::testing::Combine(
        ::testing::Values(Avatar{"Child", testing::child},
                          Avatar{"Giant", testing::giant},
                          Avatar{"LongLegs", testing::long_legs},
                          Avatar{"LongArms", long_arms},
                          Avatar{"Broad", [] { return broad(1.4); }},
                          Avatar{"APose",
                                 [] {
                                   testing::Dice dice(3);
                                   return testing::with_random_axes(
                                       testing::in_a_pose(testing::child(), 0.8), dice);
                                 }}),
        ::testing::Values(RefinedScene{"Clap", clapping, 0, P::kRightHand},
                          RefinedScene{"Head", hand_on_head, 0, P::kHead},
                          RefinedScene{"LeftHip", hands_on_hips, 0, P::kPelvis},
                          RefinedScene{"RightHip", hands_on_hips, 1, P::kPelvis},
                          RefinedScene{"Belly", hand_on_belly, 0, P::kAbdomen})),
    [](const auto& case_info) {
      return std::string(std::get<0>(case_info.param).name) +
             std::get<1>(case_info.param).name;
    });

RetargetedMotion retargeted(const Motion& source,
                            const Skeleton& avatar,
                            bool hands,
                            std::optional<BodyVolume> avatar_volume = std::nullopt,
                            bool ground = true) {
  RetargetOptions options;
  options.adapt_ground = ground;
  if (hands) options.hands.emplace().avatar_volume = std::move(avatar_volume);
  Result<RetargetedMotion> out = retarget_motion(source, avatar, options);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

double refined_gap_in(const Motion& motion, std::size_t t, int side, P part) {
  const BodyVolume volume = average_volume(motion.skeleton, mapped(motion.skeleton));
  return gap_m(volume,
               world_from_joints(motion.skeleton, motion.poses[t]),
               on_side(P::kLeftHand, side),
               part);
}

// Relative to the path from one motion's joint to the other's. [m/s^2], [m]
struct Added {
  double acceleration = 0.0;
  double distance_m = 0.0;
};
Added added(const Motion& before, const Motion& after, B bone) {
  const auto a = joint_path(before, bone);
  const auto b = joint_path(after, bone);
  Added out;
  for (std::size_t t = 0; t < a.size(); ++t) {
    out.distance_m = std::max(out.distance_m, glm::distance(a[t], b[t]));
    if (t == 0 || t + 1 >= a.size()) continue;
    const auto d = [&](std::size_t i) { return b[i] - a[i]; };
    out.acceleration = std::max(
        out.acceleration,
        glm::length(d(t - 1) - 2.0 * d(t) + d(t + 1)) * before.rate.hz * before.rate.hz);
  }
  return out;
}

TEST_P(EveryBodyAndTouch, TouchesWhereTheSourceTouches) {
  const auto& [avatar, scene] = GetParam();
  const Motion source = hands_go_to(scene.places());
  const auto out = retargeted(source, avatar.make(), true);
  EXPECT_EQ(out.report.hands.unreachable_frames, 0);
  EXPECT_LT(out.report.hands.worst_touch_error_m, 0.01);
  for (std::size_t t = kHeldFirst; t <= kHeldLast; t += 15) {
    EXPECT_NEAR(refined_gap_in(out.motion, t, scene.side, scene.part),
                refined_gap_in(source, t, scene.side, scene.part),
                0.01)
        << "frame " << t;
  }
}

// The test is meaningful: without refinement most hands miss by centimetres.
TEST(RefineHands, IsNeededBecauseRetargetingAloneMissesByCentimetres) {
  const Motion source = hands_go_to(clapping());
  const auto without = retargeted(source, broad(1.4), false);
  EXPECT_GT(refined_gap_in(without.motion, 120, 0, P::kRightHand), 0.03);
}

TEST_P(EveryBodyAndTouch, LeavesEverythingButArmsAlone) {
  const auto& [avatar, scene] = GetParam();
  const Motion source = hands_go_to(scene.places());
  const auto with = retargeted(source, avatar.make(), true);
  const auto without = retargeted(source, avatar.make(), false);
  const BodyMap map = mapped(with.motion.skeleton);
  for (std::size_t t = 0; t < with.motion.poses.size(); ++t) {
    EXPECT_EQ(with.motion.poses[t].root_in_world, without.motion.poses[t].root_in_world);
    for (std::size_t i = 0; i < map.joints.size(); ++i) {
      const JointIndex joint{static_cast<int>(i)};
      bool arm = false;
      for (const auto& limb : {map.limbs[0], map.limbs[1]}) {
        arm |= joint == limb->upper || joint == limb->lower || joint == limb->end;
      }
      if (arm) continue;
      EXPECT_EQ(with.motion.poses[t].parent_from_joint[i],
                without.motion.poses[t].parent_from_joint[i]);
    }
  }
}

// A fade over T = 0.3 s and s metres takes 5.8 s / T^2. The path itself changes while the
// hand approaches, hence twice that, and two touches of one hand may fade separately; a
// jump of 1 cm would be 36 m/s^2 more.
TEST_P(EveryBodyAndTouch, FadesWithoutJumps) {
  const auto& [avatar, scene] = GetParam();
  const Motion source = hands_go_to(scene.places());
  const auto with = retargeted(source, avatar.make(), true);
  const auto without = retargeted(source, avatar.make(), false);
  for (const B bone : {B::kLeftHand, B::kRightHand}) {
    const Added a = added(without.motion, with.motion, bone);
    EXPECT_LT(a.acceleration, 2.0 * 5.8 * a.distance_m / 0.09 + 5.0) << a.distance_m;
  }
}

TEST_P(EveryBodyAndTouch, TouchesUnderNoise) {
  const auto& [avatar, scene] = GetParam();
  const auto out =
      retargeted(hands_go_to(scene.places(), 0.003, 0.002), avatar.make(), true);
  EXPECT_LT(out.report.hands.worst_touch_error_m, 0.01);
}

TEST(RefineHands, ChangesNothingOnTheSourcesOwnBody) {
  for (const auto places : {clapping, hand_on_head, hands_on_hips, hand_on_belly}) {
    const Motion source = hands_go_to(places(), 0.003, 0.002);
    // Ground adaptation moves a noisy source's legs, and hands on them.
    const auto with = retargeted(source, source.skeleton, true, {}, false);
    const auto without = retargeted(source, source.skeleton, false, {}, false);
    for (const B bone : {B::kLeftHand, B::kRightHand, B::kLeftLowerArm}) {
      EXPECT_LT(added(without.motion, with.motion, bone).distance_m, 1e-9);
    }
  }
}

TEST(RefineHands, IsTheSameEveryTime) {
  const Motion source = hands_go_to(hands_on_hips(), 0.003, 0.002);
  const auto once = retargeted(source, testing::child(), true);
  const auto again = retargeted(source, testing::child(), true);
  for (std::size_t t = 0; t < once.motion.poses.size(); ++t) {
    EXPECT_EQ(once.motion.poses[t].parent_from_joint,
              again.motion.poses[t].parent_from_joint);
  }
}

TEST(RefineHands, TakesBodiesWithoutArms) {
  const Motion source = hands_go_to(clapping());
  Skeleton avatar = adult();
  for (const B bone : {B::kLeftHand, B::kLeftLowerArm, B::kRightHand}) {
    avatar = testing::without(avatar, bone);
  }
  const auto out = retargeted(source, avatar, true);
  EXPECT_EQ(out.report.hands.worst_touch_error_m, 0.0);
}

// Returns the depth of a motion's forearms and hands in abdomen, pelvis and thighs.
double deepest_of_hands_m(const Motion& motion, const BodyVolume& volume) {
  double deepest = 0.0;
  for (std::size_t t = 0; t < motion.poses.size(); t += 3) {
    const auto joints = world_from_joints(motion.skeleton, motion.poses[t]);
    for (int side = 0; side < 2; ++side) {
      for (const P arm : {P::kLeftForearm, P::kLeftHand}) {
        for (const P part :
             {P::kAbdomen, P::kPelvis, P::kChest, P::kLeftThigh, P::kRightThigh}) {
          deepest = std::max(deepest, -gap_m(volume, joints, on_side(arm, side), part));
        }
      }
    }
  }
  return deepest;
}

struct Belly {
  Motion source;
  BodyVolume volume;
};

Belly hanging_next_to_belly(double factor) {
  Motion source = hands_go_to({});
  const BodyMap map = mapped(source.skeleton);
  // They swing slightly, as arms do.
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    const double angle = 0.3 * std::sin(0.1 * static_cast<double>(t));
    const double inwards = 0.2;
    for (const std::size_t side : {0u, 1u}) {
      glm::dquat& q = source.poses[t].parent_from_joint[index(map.limbs[side]->upper)];
      q = glm::angleAxis(side == 0 ? angle : -angle, glm::dvec3(1, 0, 0)) *
          glm::angleAxis(side == 0 ? -inwards : inwards, glm::dvec3(0, 0, 1)) * q;
    }
  }
  return {source, with_belly(average_volume(source.skeleton, map), factor)};
}

TEST(ResolveArmCollisions, PutsHangingArmsOutOfABiggerBelly) {
  const Belly scene = hanging_next_to_belly(1.5);
  const auto without = retargeted(scene.source, scene.source.skeleton, false);
  const auto with = retargeted(scene.source, scene.source.skeleton, true, scene.volume);
  EXPECT_GT(deepest_of_hands_m(without.motion, scene.volume), 0.02);
  EXPECT_LT(deepest_of_hands_m(with.motion, scene.volume), 0.005);
  EXPECT_LT(with.report.hands.arms.max_depth_after_m, 0.005);
}

TEST(ResolveArmCollisions, MovesThemSmoothly) {
  const Belly scene = hanging_next_to_belly(1.5);
  const auto without = retargeted(scene.source, scene.source.skeleton, false);
  const auto with = retargeted(scene.source, scene.source.skeleton, true, scene.volume);
  for (const B bone : {B::kLeftHand, B::kRightHand, B::kLeftLowerArm}) {
    const Added a = added(without.motion, with.motion, bone);
    EXPECT_GT(a.distance_m, 0.02);
    EXPECT_LT(a.acceleration, 2.0 * 5.8 * a.distance_m / 0.09) << a.distance_m;
  }
}

TEST(ResolveArmCollisions, ChangesNothingOnTheSourcesOwnBody) {
  const Belly scene = hanging_next_to_belly(1.0);
  const auto without = retargeted(scene.source, scene.source.skeleton, false);
  const auto with = retargeted(scene.source, scene.source.skeleton, true, scene.volume);
  EXPECT_LT(added(without.motion, with.motion, B::kLeftHand).distance_m, 1e-9);
  EXPECT_LT(added(without.motion, with.motion, B::kLeftLowerArm).distance_m, 1e-9);
}

TEST(ResolveArmCollisions, LiftsHandsOverTheFloorByTheirElbows) {
  const Belly scene = hanging_next_to_belly(1.0);
  const auto without = retargeted(scene.source, ape(), false);
  const auto with = retargeted(scene.source, ape(), true);
  EXPECT_GT(deepest_hand_m(without.motion), 0.08) << "the claim is empty";
  EXPECT_LT(deepest_hand_m(with.motion), 0.005);
  for (const B bone : {B::kLeftHand, B::kRightHand, B::kLeftLowerArm}) {
    const Added a = added(without.motion, with.motion, bone);
    EXPECT_LT(a.acceleration, 2.0 * 5.8 * a.distance_m / 0.09) << a.distance_m;
  }
  // Without a floor no hand is raised.
  const auto nowhere = retargeted(scene.source, ape(), true, std::nullopt, false);
  EXPECT_GT(deepest_hand_m(nowhere.motion), 0.08);
}

// The source's contact with its belly is kept on the larger one: the hand lies on it.
TEST(ResolveArmCollisions, LaysAHandOnABiggerBelly) {
  const Motion source = hands_go_to(hand_on_belly());
  const BodyMap map = mapped(source.skeleton);
  const BodyVolume own = average_volume(source.skeleton, map);
  const BodyVolume belly = with_belly(own, 1.5);
  const auto out = retargeted(source, source.skeleton, true, belly);
  for (std::size_t t = kHeldFirst; t <= kHeldLast; t += 10) {
    const auto joints = world_from_joints(out.motion.skeleton, out.motion.poses[t]);
    EXPECT_NEAR(gap_m(belly, joints, P::kLeftHand, P::kAbdomen), 0.003, 0.01);
  }
  EXPECT_LT(deepest_of_hands_m(out.motion, belly),
            deepest_of_hands_m(source, own) + 0.005);
}

// A hand on a hip next to a belly that overlaps it slides until it is clear of both.
TEST(ResolveArmCollisions, SlidesHandsOnHipsOutOfABiggerBelly) {
  const Motion source = hands_go_to(hands_on_hips());
  const BodyMap map = mapped(source.skeleton);
  const BodyVolume belly = with_belly(average_volume(source.skeleton, map), 1.5);
  const auto out = retargeted(source, source.skeleton, true, belly);
  EXPECT_LT(out.report.hands.worst_touch_error_m, 0.01);
  EXPECT_LT(out.report.hands.arms.max_depth_after_m, 0.005);
}

// Hands that clap in front of a larger belly leave it together.
TEST(ResolveArmCollisions, KeepsHandsTogetherBeforeABiggerBelly) {
  const Motion source = hands_go_to(clapping());
  const BodyMap map = mapped(source.skeleton);
  const BodyVolume belly = with_belly(average_volume(source.skeleton, map), 2.2);
  const auto out = retargeted(source, source.skeleton, true, belly);
  EXPECT_LT(out.report.hands.worst_touch_error_m, 0.01);
}

TEST(ResolveArmCollisions, LetsAWalkPassABiggerBelly) {
  const Motion source = testing::synthetic_walk(200, 60.0).motion;
  const BodyMap map = mapped(source.skeleton);
  const BodyVolume belly = with_belly(average_volume(source.skeleton, map), 1.5);
  const auto out = retargeted(source, source.skeleton, true, belly);
  EXPECT_LT(out.report.hands.arms.max_depth_after_m, 0.005);
}

}  // namespace
}  // namespace marey::retarget
