// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies that differ only in the number of bones between hips and neck: a posture puts
// neck, shoulders and wrists at the source's positions, as far as those bones can.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/hands/keep_wrists.h"
#include "retarget/motion/live_retarget.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/retarget/motion/spine_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

constexpr int kMaxCount = 6;
constexpr std::array kUpperBody{B::kNeck,
                                B::kHead,
                                B::kLeftShoulder,
                                B::kLeftUpperArm,
                                B::kRightShoulder,
                                B::kRightUpperArm};

double worst_m(const Skeleton& source,
               const std::vector<RigidTransform>& from,
               const Skeleton& body,
               const std::vector<RigidTransform>& to,
               std::span<const B> bones) {
  double worst = 0.0;
  for (const B bone : bones) {
    worst =
        std::max(worst, glm::distance(place(source, from, bone), place(body, to, bone)));
  }
  return worst;
}

// Returns the length by which the bones between the first vertebra and the last are too
// short for a spine whose hips and last vertebra are turned as the source's, and whose
// neck is at the source's. No rotation of them can reduce it. [m]
double too_short_m(const Skeleton& source,
                   const std::vector<RigidTransform>& from,
                   const Skeleton& body,
                   int source_count,
                   int count) {
  const auto rest = world_from_joints(body, rest_pose(body));
  const auto bone = [&](std::size_t low, const glm::dvec3& high) {
    return high - rest[low].translation;
  };
  const auto last = static_cast<std::size_t>(count);
  const glm::dvec3 lowest = from[0].rotation * bone(0, rest[1].translation);
  const glm::dvec3 highest = from[static_cast<std::size_t>(source_count)].rotation *
                             bone(last, place(body, rest, B::kNeck));
  const glm::dvec3 between =
      place(source, from, B::kNeck) - from[0].translation - lowest - highest;
  const double reach = glm::length(bone(1, rest[last].translation));
  return std::max(glm::length(between) - reach, 0.0);
}

// From any count to three and more: within a millimetre, or the missing length. Rotations
// are the source's throughout.
TEST(SpineCount, ThreeBonesAndMorePutNeckAndShouldersWhereTheSourceHasThem) {
  for (int m = 1; m <= kMaxCount; ++m) {
    const Skeleton source = with_count(m);
    const BodyMap source_map = mapped(source);
    for (int n = 3; n <= kMaxCount; ++n) {
      const Skeleton body = with_count(n);
      const BodyMap map = mapped(body);
      Dice dice(71);
      for (int k = 0; k < 100; ++k) {
        const Pose pose = random_upper_body(source, m, 0.6, dice);
        const auto from = world_from_joints(source, pose);
        const auto to = world_from_joints(
            body, expand(normalize(source, source_map, pose), body, map));
        // Three bones must bend more sharply at their one free joint than two do.
        const double sharp_m = m == 2 && n == 3 ? 0.5e-3 : 0.0;
        const double allowed_m = 1e-3 + sharp_m + too_short_m(source, from, body, m, n);
        ASSERT_LT(worst_m(source, from, body, to, kUpperBody), allowed_m)
            << m << " to " << n << ", posture " << k;
      }
    }
  }
}

struct Bend {
  const char* name;
  std::function<glm::dquat(int, int)> turn;
};

// Typical human bends: 60 degrees forwards, sideways and about themselves, an S.
TEST(SpineCount, ThreeBonesAndMoreFollowBendsThatPeopleMake) {
  const auto about = [](const glm::dvec3& axis, double whole_rad) {
    return [=](int, int count) { return glm::angleAxis(whole_rad / count, axis); };
  };
  const std::vector<Bend> bends{
      {"forwards", about({1, 0, 0}, 1.0)},
      {"backwards", about({1, 0, 0}, -0.5)},
      {"sideways", about({0, 0, 1}, 0.6)},
      {"twist", about({0, 1, 0}, 0.8)},
      {"forwards and twisted", about(glm::normalize(glm::dvec3(1, 1, 0)), 1.0)},
      {"an S", [](int k, int count) {
         const double way = (2.0 * k + 1.0) / count - 1.0;
         return glm::angleAxis(0.8 * way / count, glm::dvec3(1, 0, 0));
       }}};
  for (const Bend& bend : bends) {
    for (int m = 3; m <= kMaxCount; ++m) {
      const Skeleton source = with_count(m);
      const Pose pose = bent(source, m, bend.turn);
      const auto from = world_from_joints(source, pose);
      for (int n = 3; n <= kMaxCount; ++n) {
        const Skeleton body = with_count(n);
        const auto to = world_from_joints(
            body, expand(normalize(source, mapped(source), pose), body, mapped(body)));
        EXPECT_LT(worst_m(source, from, body, to, kUpperBody),
                  1e-3 + too_short_m(source, from, body, m, n))
            << bend.name << " " << m << " to " << n;
      }
    }
  }
}

TEST(SpineCount, GetsItsOwnPostureBackExactly) {
  for (int n = 1; n <= kMaxCount; ++n) {
    const Skeleton body = with_count(n);
    const BodyMap map = mapped(body);
    Dice dice(72);
    for (int k = 0; k < 100; ++k) {
      const Pose pose = random_upper_body(body, n, 2.0, dice);
      const auto from = world_from_joints(body, pose);
      const auto to =
          world_from_joints(body, expand(normalize(body, map, pose), body, map));
      for (std::size_t i = 0; i < from.size(); ++i) {
        ASSERT_LT(glm::distance(from[i].translation, to[i].translation), 1e-9);
        ASSERT_LT(glm::length(
                      rotation_vector(glm::conjugate(from[i].rotation) * to[i].rotation)),
                  1e-7);
      }
    }
  }
}

// Arms compensate the spine's residual: wrists within a millimetre where the arm reaches.
TEST(SpineCount, WristsAreWhereTheSourceHasThem) {
  const Skeleton source = with_count(3);
  const BodyMap source_map = mapped(source);
  for (int n = 1; n <= kMaxCount; ++n) {
    const Skeleton body = with_count(n);
    const BodyMap map = mapped(body);
    ASSERT_EQ(spines_differ(source_map, map), n != 3);
    Dice dice(75);
    Motion motion{source, {60.0}, 0, {}};
    for (int k = 0; k < 100; ++k) {
      motion.poses.push_back(random_upper_body(source, 3, 0.75, dice));
    }
    RetargetOptions options;
    options.adapt_ground = false;
    const auto whole = retarget_motion(motion, body, options);
    ASSERT_TRUE(whole);
    LiveRetargetOptions live_options;
    live_options.hold_feet = false;
    live_options.hands.reset();
    auto live = LiveRetarget::make(source, body, live_options);
    ASSERT_TRUE(live);
    Pose out;
    int reached = 0;
    for (std::size_t k = 0; k < motion.poses.size(); ++k) {
      live->step(motion.poses[k], 1.0 / 60.0, out);
      const auto from = world_from_joints(source, motion.poses[k]);
      for (const Pose& pose : {whole->motion.poses[k], out}) {
        const auto to = world_from_joints(body, pose);
        for (const int side : {0, 1}) {
          const LimbMap& arm = *map.limbs[static_cast<std::size_t>(side)];
          const B hand = side == 0 ? B::kLeftHand : B::kRightHand;
          const glm::dvec3 wrist = place(source, from, hand);
          const double asked_m = glm::distance(wrist, to[index(arm.upper)].translation);
          if (asked_m > 0.97 * arm.length_m() ||
              asked_m < std::abs(arm.upper_length_m - arm.lower_length_m)) {
            continue;
          }
          ++reached;
          ASSERT_LT(glm::distance(wrist, place(body, to, hand)), 1e-3) << n << " " << k;
        }
      }
    }
    EXPECT_GE(reached, 300);
  }
}

}  // namespace
}  // namespace marey::retarget
