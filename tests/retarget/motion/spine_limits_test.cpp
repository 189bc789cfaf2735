// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Limits of a spine with other bones: its residual and its continuity.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/motion/live_retarget.h"
#include "tests/retarget/mapped.h"
#include "tests/retarget/motion/spine_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

// Returns the squared distances of neck and collar bones from the source's. [m2]
double squares(const Skeleton& source,
               const std::vector<RigidTransform>& from,
               const Skeleton& body,
               const std::vector<RigidTransform>& to) {
  double sum = 0.0;
  for (const B bone : {B::kNeck, B::kLeftShoulder, B::kRightShoulder}) {
    const glm::dvec3 off = place(source, from, bone) - place(body, to, bone);
    sum += glm::dot(off, off);
  }
  return sum;
}

// Returns the minimum of squares() over rotations of one vertebra in the world, with all
// vertebrae above it keeping their rotations. [m2]
double least_squares_nearby(const Skeleton& source,
                            const std::vector<RigidTransform>& from,
                            const Skeleton& body,
                            int count,
                            Pose pose) {
  auto world = world_from_joints(body, pose);
  double best = squares(source, from, body, world);
  const auto turned = [&](std::size_t k, const glm::dquat& by) {
    Pose out = pose;
    const glm::dquat parent = world[k - 1].rotation;
    const glm::dquat now = by * world[k].rotation;
    out.parent_from_joint[k] = glm::conjugate(parent) * now;
    for (std::size_t i = k + 1; i < body.joints.size(); ++i) {
      if (body.joints[i].parent != JointIndex{static_cast<int>(k)}) continue;
      out.parent_from_joint[i] = glm::conjugate(now) * world[i].rotation;
    }
    return out;
  };
  for (double step = 0.05; step > 1e-4;) {
    bool better = false;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(count); ++k) {
      for (const double sign : {-1.0, 1.0}) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
          glm::dvec3 v(0.0);
          v[axis] = sign * step;
          const Pose tried = turned(k, rotation_from_vector(v));
          const auto there = world_from_joints(body, tried);
          const double sum = squares(source, from, body, there);
          if (sum >= best) continue;
          best = sum;
          pose = tried;
          world = there;
          better = true;
        }
      }
    }
    if (!better) step *= 0.5;
  }
  return best;
}

// If the bones cannot reach the target, their residual is minimal: a search over
// rotations finds hardly a smaller one. (The search weights rotations of the last
// vertebra only by the points that it carries.)
TEST(SpineLimits, OneAndTwoBonesComeAsNearAsTheyCan) {
  const Skeleton source = with_count(3);
  const BodyMap source_map = mapped(source);
  for (int n = 1; n <= 2; ++n) {
    const Skeleton body = with_count(n);
    const BodyMap map = mapped(body);
    Dice dice(73);
    for (int k = 0; k < 30; ++k) {
      const Pose pose = random_upper_body(source, 3, 0.75, dice);
      const auto from = world_from_joints(source, pose);
      const Pose out = expand(normalize(source, source_map, pose), body, map);
      const double reached =
          std::sqrt(squares(source, from, body, world_from_joints(body, out)) / 3.0);
      const double possible =
          std::sqrt(least_squares_nearby(source, from, body, n, out) / 3.0);
      EXPECT_LT(reached, 1.15 * possible + 3e-4) << n << " bones, posture " << k;
    }
  }
}

// One bone has a fixed length: the neck misses by its excess or lack of length.
TEST(SpineLimits, OneBoneMissesByLittleMoreThanItsLength) {
  const Skeleton source = with_count(3);
  const BodyMap source_map = mapped(source);
  const Skeleton body = with_count(1);
  const BodyMap map = mapped(body);
  Dice dice(74);
  double worst_bound_m = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Pose pose = random_upper_body(source, 3, 0.75, dice);
    const auto from = world_from_joints(source, pose);
    const auto to =
        world_from_joints(body, expand(normalize(source, source_map, pose), body, map));
    const glm::dvec3 wanted = place(source, from, B::kNeck) - to[1].translation;
    const double bone_m = glm::length(map.torso.bone_in_t_pose[0]);
    const double bound_m = std::abs(glm::length(wanted) - bone_m);
    EXPECT_LT(glm::distance(place(source, from, B::kNeck), place(body, to, B::kNeck)),
              bound_m + 7e-3);
    worst_bound_m = std::max(worst_bound_m, bound_m);
  }
  EXPECT_GT(worst_bound_m, 8e-3);  // No solver could meet a bound of a millimetre.
}

// Returns the maximum angular speed of a vertebra over that of the source's fastest, as
// bends pass through straight.
double steepest(const Skeleton& source, const Skeleton& body, int count) {
  const BodyMap source_map = mapped(source);
  const BodyMap map = mapped(body);
  Dice dice(76);
  double worst = 0.0;
  for (int path = 0; path < 40; ++path) {
    std::array<glm::dvec3, 3> turn;
    std::array<glm::dvec3, 3> middle;
    for (std::size_t i = 0; i < 3; ++i) {
      turn[i] = dice.between(0.0, 0.25) * dice.direction();
      middle[i] =
          path % 2 == 0 ? glm::dvec3(0.0) : dice.between(0.0, 0.25) * dice.direction();
    }
    std::vector<RigidTransform> from;
    std::vector<RigidTransform> to;
    for (int step = -250; step <= 250; ++step) {
      const Pose pose = bent(source, 3, [&](int k, int) {
        const auto i = static_cast<std::size_t>(k);
        return rotation_from_vector(middle[i] + 0.004 * step * turn[i]);
      });
      const auto from_now = world_from_joints(source, pose);
      const auto to_now =
          world_from_joints(body, expand(normalize(source, source_map, pose), body, map));
      const auto fastest = [](const auto& a, const auto& b, int joints) {
        double maximum = 0.0;
        for (std::size_t i = 0; i <= static_cast<std::size_t>(joints); ++i) {
          maximum = std::max(maximum,
                             glm::length(rotation_vector(glm::conjugate(a[i].rotation) *
                                                         b[i].rotation)));
        }
        return maximum;
      };
      if (!from.empty()) {
        worst = std::max(worst, fastest(to, to_now, count) / fastest(from, from_now, 3));
      }
      from = from_now;
      to = to_now;
    }
  }
  return worst;
}

// No vertebra flips as a bend passes zero, or buckles at once.
TEST(SpineLimits, VertebraeTurnHardlyMoreThanThreeTimesAsFastAsTheSources) {
  for (int n = 1; n <= 8; ++n) {
    EXPECT_LT(steepest(with_count(3), with_count(n), n), 3.5) << n;
  }
}

// A vertebra without length, as in some recordings below the neck, is a knot at the
// curve's end: the vertebrae before it do not turn further than their neighbours.
TEST(SpineLimits, AVertebraWithoutLengthSpinsNoOther) {
  Skeleton source = with_count(3);
  const auto neck = *source.find(B::kNeck);
  source.joints[3].parent_from_joint.translation +=
      source[neck].parent_from_joint.translation;
  for (Joint& joint : source.joints) {
    if (joint.parent != JointIndex{3}) continue;
    joint.parent_from_joint.translation -= source[neck].parent_from_joint.translation;
  }
  source.joints[index(neck)].parent_from_joint.translation = glm::dvec3(0.0);
  const Skeleton body = with_count(6);
  const Pose pose = bent(source, 3, [](int k, int) {
    return glm::angleAxis(k == 2 ? 0.4 : 0.1, glm::dvec3(1, 0, 0));
  });
  const Pose out = expand(normalize(source, mapped(source), pose), body, mapped(body));
  for (std::size_t k = 1; k <= 6; ++k) {
    EXPECT_LT(glm::length(rotation_vector(out.parent_from_joint[k])), 0.5) << k;
  }
}

TEST(SpineLimits, AllocatesNothingLive) {
  const Skeleton source = with_count(3);
  const Skeleton body = with_count(2);
  auto live = LiveRetarget::make(source, body);
  ASSERT_TRUE(live);
  Dice dice(77);
  const Pose pose = random_upper_body(source, 3, 0.75, dice);
  Pose out = rest_pose(body);
  live->step(pose, 1.0 / 60.0, out);
  const long before = testing::allocations();
  for (int k = 0; k < 100; ++k) live->step(pose, 1.0 / 60.0, out);
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::retarget
