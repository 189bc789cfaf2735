// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/follow_com.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/com/foot_goals.h"
#include "retarget/com/raise_heel.h"
#include "tests/retarget/com/com_scenes.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::retarget {
namespace {

constexpr int kBodies = 300;

bool same_bits(const Pose& a, const Pose& b) {
  return std::memcmp(&a.root_in_world, &b.root_in_world, sizeof a.root_in_world) == 0 &&
         a.parent_from_joint.size() == b.parent_from_joint.size() &&
         std::memcmp(a.parent_from_joint.data(),
                     b.parent_from_joint.data(),
                     a.parent_from_joint.size() * sizeof(glm::dquat)) == 0;
}

double turned_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(a * glm::conjugate(b)));
}

// Largest deviation of a foot in a pose from a place: [m] and [rad] as one number.
double off_place(const HeavyBody& body, const Pose& pose, int side, const FootPlace& p) {
  const Motion motion{body.skeleton, {60.0}, 0, {pose}};
  const FootPlace now = foot_places(motion, body.map, side)[0];
  double off = glm::distance(now.ankle_in_world, p.ankle_in_world);
  off = std::max(off, turned_rad(now.foot, p.foot));
  if (body.map.feet[static_cast<std::size_t>(side)].has_toes) {
    off = std::max(off, turned_rad(now.toes, p.toes));
  }
  return off;
}

TEST(FollowCom, MovesTheWholeBodyToTheTargetWithoutHeldFoot) {
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(1000 + static_cast<std::uint64_t>(seed));
    const Pose reference = testing::random_pose(body.skeleton, dice);
    const glm::dvec3 target =
        body.com(reference) + dice.between(0.0, 1.0) * dice.direction();
    const Followed out =
        followed(body, reference, target, own_feet(body, reference, 0.0, 0.0));
    EXPECT_LT(glm::distance(body.com(out.pose), target), 1e-12) << seed;
    EXPECT_EQ(std::memcmp(out.pose.parent_from_joint.data(),
                          reference.parent_from_joint.data(),
                          reference.parent_from_joint.size() * sizeof(glm::dquat)),
              0);
  }
}

TEST(FollowCom, KeepsBothFeetAndReachesEveryReachableTarget) {
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(2000 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.7, 1.6), dice);
    const glm::dvec3 target = body.com(reference) + 0.06 * body.map.leg_length_m *
                                                        dice.between(0.0, 1.0) *
                                                        dice.direction();
    const auto feet = own_feet(body, reference, 1.0, 0.0);
    const Followed out = followed(body, reference, target, feet);
    ASSERT_LT(glm::distance(body.com(out.pose), target), 1e-8) << seed;
    for (int side = 0; side < 2; ++side) {
      EXPECT_LT(
          off_place(body, out.pose, side, feet[static_cast<std::size_t>(side)].place),
          1e-9)
          << seed;
    }
    EXPECT_LT(stretched_m(body, out.pose), 1e-12) << seed;
    EXPECT_EQ(out.report.short_leg_frames, 0) << seed;
    for (std::size_t i = 0; i < body.skeleton.joints.size(); ++i) {
      const auto bone = body.skeleton.joints[i].bone;
      const bool is_leg =
          bone && (body.map.joints[i].role == JointRole::kLimbBone ||
                   bone == HumanBone::kLeftFoot || bone == HumanBone::kRightFoot ||
                   bone == HumanBone::kLeftToes || bone == HumanBone::kRightToes);
      if (is_leg) continue;
      EXPECT_EQ(std::memcmp(&out.pose.parent_from_joint[i],
                            &reference.parent_from_joint[i],
                            sizeof(glm::dquat)),
                0)
          << body.skeleton.joints[i].name;
    }
  }
}

TEST(FollowCom, MovesFeetToOtherPlacesWithOtherRotations) {
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(2500 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.9, 1.4), dice);
    auto feet = own_feet(body, reference, 1.0, 0.0);
    for (FootGoal& foot : feet) {
      foot.place.ankle_in_world +=
          0.05 * body.map.leg_length_m * dice.between(0.0, 1.0) * dice.direction();
      foot.place.foot = dice.turn(0.3) * foot.place.foot;
      foot.place.toes = dice.turn(0.3) * foot.place.toes;
    }
    const Followed out = followed(body, reference, body.com(reference), feet);
    ASSERT_LT(glm::distance(body.com(out.pose), body.com(reference)), 1e-8) << seed;
    for (int side = 0; side < 2; ++side) {
      EXPECT_LT(
          off_place(body, out.pose, side, feet[static_cast<std::size_t>(side)].place),
          1e-9)
          << seed;
    }
  }
}

TEST(FollowCom, KeepsAFrameWithItsOwnTargetAndPlacesToTheBit) {
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(3000 + static_cast<std::uint64_t>(seed));
    const Pose reference = testing::random_pose(body.skeleton, dice);
    for (const double hold : {0.0, 0.4, 1.0}) {
      const Followed out = followed(
          body, reference, body.com(reference), own_feet(body, reference, hold, 1.0));
      EXPECT_TRUE(same_bits(out.pose, reference)) << seed;
    }
  }
}

TEST(FollowCom, ReportsATargetOutOfReachAndStretchesNothing) {
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(4000 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.2, 1.2), dice);
    const double leg_m = body.map.leg_length_m;
    const glm::dvec3 target =
        body.com(reference) +
        glm::dvec3(dice.between(-0.1, 0.1), dice.between(0.5, 1.0), 0.0) * leg_m;
    const auto feet = own_feet(body, reference, 1.0, 0.0);
    const Followed out = followed(body, reference, target, feet);
    const double off_m = glm::distance(body.com(out.pose), target);
    EXPECT_GT(off_m, 0.01 * leg_m) << seed;
    EXPECT_NEAR(out.report.worst_com_m, off_m, 1e-9) << seed;
    EXPECT_GT(out.report.short_leg_m, 0.01 * leg_m) << seed;
    EXPECT_EQ(out.report.short_leg_frames, 1) << seed;
    EXPECT_LT(stretched_m(body, out.pose), 1e-12) << seed;
    for (int side = 0; side < 2; ++side) {
      EXPECT_LE(extension(body, out.pose, side),
                std::max(0.995, extension(body, reference, side)) + 1e-9)
          << seed;
      EXPECT_LT(
          off_place(body, out.pose, side, feet[static_cast<std::size_t>(side)].place),
          1e-6)
          << seed;
    }
  }
}

// Remaining angle until the heel is as high as it can be: the sole's pitch or the foot's
// own elevation is at its limit, or the ankle is between the pivot and the hip.
double left_rad(const HeavyBody& body, const Pose& pose, int side) {
  const FootMap& shape = body.map.feet[static_cast<std::size_t>(side)];
  const Motion motion{body.skeleton, {60.0}, 0, {pose}};
  const FootPlace place = foot_places(motion, body.map, side)[0];
  const glm::dvec3 flat =
      -(shape.has_toes ? shape.ball_from_ankle_in_t_pose
                       : shape.ball_from_ankle_in_t_pose + shape.tip_from_ball_in_t_pose);
  const glm::dvec3 now = place.foot * flat;
  const glm::dvec3 hip = body.place(pose, body.map.leg(side).upper);
  const auto elevation = [](const glm::dvec3& v) {
    return std::atan2(v.y, std::hypot(v.x, v.z));
  };
  const double to_hip =
      glm::dot(glm::normalize(hip - place.ankle_in_world), glm::normalize(now));
  // The foot turns about one axis only, so the ankle passes the line at a distance.
  const double beside_rad = to_hip > 0.98 ? 0.0 : 1.0;
  return std::min({kMaxHeelPitch_rad - (elevation(now) - elevation(flat)),
                   1.48 - elevation(now),
                   beside_rad});
}

// Checks that a foot rose about its pivot, with flat toes, and no leg is too long.
void expect_on_the_ball(const HeavyBody& body,
                        const Pose& pose,
                        int side,
                        FootPlace before) {
  const FootMap& shape = body.map.feet[static_cast<std::size_t>(side)];
  const glm::dvec3 pivot =
      shape.has_toes ? shape.ball_from_ankle_in_t_pose
                     : shape.ball_from_ankle_in_t_pose + shape.tip_from_ball_in_t_pose;
  const Motion motion{body.skeleton, {60.0}, 0, {pose}};
  const FootPlace now = foot_places(motion, body.map, side)[0];
  EXPECT_LT(glm::distance(now.ankle_in_world + now.foot * pivot,
                          before.ankle_in_world + before.foot * pivot),
            1e-9);
  EXPECT_GE(now.ankle_in_world.y, before.ankle_in_world.y - 1e-12);
  if (shape.has_toes) {
    EXPECT_LT(turned_rad(now.toes, before.toes), 1e-9);
  }
  EXPECT_LE(extension(body, pose, side), 0.995 + 1e-9);
}

TEST(FollowCom, RaisesTheHeelAboutTheBallBeforeTheCentreOfMassFallsShort) {
  int raised = 0;
  int at_limit = 0;
  for (int seed = 0; seed < kBodies; ++seed) {
    SCOPED_TRACE(seed);
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(5000 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, 0.5, dice);
    const double foot_m = glm::length(body.map.feet[0].ball_from_ankle_in_t_pose);
    const glm::dvec3 target =
        body.com(reference) +
        glm::dvec3(0.0, 0.05 * body.map.leg_length_m + 0.1 * foot_m, 0.0);
    const auto flat = own_feet(body, reference, 1.0, 0.0);
    const auto rising = own_feet(body, reference, 1.0, 1.0);
    const Followed low = followed(body, reference, target, flat);
    const Followed high = followed(body, reference, target, rising);
    if (glm::distance(body.com(low.pose), target) < 1e-3) continue;
    double least_rad = 1.0;
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      expect_on_the_ball(body, high.pose, side, flat[s].place);
      least_rad = std::min(least_rad, left_rad(body, high.pose, side));
    }
    EXPECT_GT(high.report.raised_heel_m, 1e-4);
    if (glm::distance(body.com(high.pose), target) < 1e-8) {
      ++raised;
      continue;
    }
    // Only where the heel cannot rise further does the centre of mass fall short.
    ++at_limit;
    EXPECT_LT(least_rad, 1e-6);
    EXPECT_LT(glm::distance(body.com(high.pose), target),
              glm::distance(body.com(low.pose), target));
  }
  EXPECT_GT(raised, kBodies / 3);
  EXPECT_LT(at_limit, raised / 10);
}

TEST(FollowCom, KeepsTheTargetAndLeavesThePlaceWhereTheRootDoesNotGiveWay) {
  for (int seed = 0; seed < 100; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(5500 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.4, 1.2), dice);
    const glm::dvec3 target =
        body.com(reference) + glm::dvec3(0.0, 0.5 * body.map.leg_length_m, 0.0);
    auto feet = own_feet(body, reference, 1.0, 0.0);
    for (FootGoal& foot : feet) foot.root_gives_way = 0.0;
    const Followed out = followed(body, reference, target, feet);
    EXPECT_LT(glm::distance(body.com(out.pose), target), 1e-8) << seed;
    EXPECT_LT(stretched_m(body, out.pose), 1e-12) << seed;
    EXPECT_GT(out.report.worst_foot_m, 0.05 * body.map.leg_length_m) << seed;
    for (int side = 0; side < 2; ++side) {
      EXPECT_LE(extension(body, out.pose, side), 0.995 + 1e-9) << seed;
    }
  }
}

TEST(FollowCom, IsMirroredWithItsBody) {
  for (int seed = 0; seed < 100; ++seed) {
    testing::Dice dice(6000 + static_cast<std::uint64_t>(seed));
    const HeavyBody body = heavy(testing::random_humanoid(dice));
    const HeavyBody other = heavy(testing::mirrored_body(body.skeleton));
    const Pose reference = squatting(body, dice.between(0.2, 1.4), dice);
    const auto reflect = [&](const Pose& pose) {
      Pose out = pose;
      out.root_in_world.x *= -1.0;
      for (glm::dquat& q : out.parent_from_joint) q = glm::dquat(q.w, q.x, -q.y, -q.z);
      return out;
    };
    const glm::dvec3 target =
        body.com(reference) + 0.1 * body.map.leg_length_m * dice.direction();
    const Pose mirror = reflect(reference);
    const Followed one =
        followed(body, reference, target, own_feet(body, reference, 1.0, 1.0));
    const Followed two = followed(
        other, mirror, target * glm::dvec3(-1, 1, 1), own_feet(other, mirror, 1.0, 1.0));
    EXPECT_LT(moved_m(other, two.pose, reflect(one.pose)), 1e-7) << seed;
  }
}

TEST(FollowCom, ChangesJointsLittleForASmallChangeOfTheTarget) {
  double worst = 0.0;
  for (int seed = 0; seed < kBodies; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(7000 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.3, 1.5), dice);
    const auto feet = own_feet(body, reference, 1.0, seed % 2);
    const glm::dvec3 way = dice.direction();
    Pose before = reference;
    // 60 steps of 1/500 leg each: 2 mm for an adult's leg.
    const double step_m = 0.002 * body.map.leg_length_m;
    for (int k = 1; k <= 60; ++k) {
      const Pose now =
          followed(body, reference, body.com(reference) + k * step_m * way, feet).pose;
      worst = std::max(worst, moved_m(body, before, now) / step_m);
      before = now;
    }
  }
  // Near a straight leg the knee moves faster than the hip.
  EXPECT_LT(worst, 12.0);
}

TEST(FollowCom, ChangesJointsLittleForASmallChangeOfTheHold) {
  double worst = 0.0;
  for (int seed = 0; seed < 100; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(8000 + static_cast<std::uint64_t>(seed));
    const Pose reference = squatting(body, dice.between(0.8, 1.2), dice);
    const double leg_m = body.map.leg_length_m;
    const glm::dvec3 target = body.com(reference) + 0.08 * leg_m * dice.direction();
    Pose before = followed(body, reference, target, own_feet(body, reference, 0, 0)).pose;
    for (int k = 1; k <= 100; ++k) {
      const Pose now =
          followed(body, reference, target, own_feet(body, reference, 0.01 * k, 0)).pose;
      worst = std::max(worst, moved_m(body, before, now) / (0.01 * leg_m));
      before = now;
    }
  }
  // The feet move by 0.08 legs between hold 0 and 1.
  EXPECT_LT(worst, 0.4);
}

TEST(FollowCom, AllocatesNothingPerFrame) {
  const HeavyBody body = heavy_body(2);
  testing::Dice dice(9);
  const Pose pose = squatting(body, 0.8, dice);
  const auto allocations_of = [&](std::size_t frames) {
    const std::vector<Pose> reference(frames, pose);
    const std::vector<glm::dvec3> com(frames, body.com(pose) + glm::dvec3(0, 0.03, 0));
    const auto goal = own_feet(body, pose, 1.0, 1.0);
    const std::vector<FootGoal> left(frames, goal[0]);
    const std::vector<FootGoal> right(frames, goal[1]);
    std::vector<Pose> out(frames, pose);
    const long before = testing::allocations();
    static_cast<void>(follow_com(body.follower(), {reference, com, {left, right}}, out));
    return testing::allocations() - before;
  };
  EXPECT_EQ(allocations_of(200), allocations_of(1));
}

TEST(FollowCom, MayWriteOverItsReference) {
  const HeavyBody body = heavy_body(4);
  testing::Dice dice(10);
  Pose pose = squatting(body, 0.8, dice);
  const glm::dvec3 target = body.com(pose) + glm::dvec3(0.01, 0.02, 0.0);
  const auto feet = own_feet(body, pose, 1.0, 1.0);
  const Pose apart = followed(body, pose, target, feet).pose;
  const ComPlan plan{std::span<const Pose>(&pose, 1),
                     std::span(&target, 1),
                     {std::span(&feet[0], 1), std::span(&feet[1], 1)}};
  static_cast<void>(follow_com(body.follower(), plan, std::span(&pose, 1)));
  EXPECT_TRUE(same_bits(pose, apart));
}

}  // namespace
}  // namespace marey::retarget
