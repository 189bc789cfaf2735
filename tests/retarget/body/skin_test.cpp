// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/skin.h"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::retarget {
namespace {

// Returns points about every joint, each carried by it and some of its ancestors.
std::vector<SkinVertex> random_skin(const Skeleton& body, testing::Dice& dice) {
  const auto rest = world_from_joints(body, rest_pose(body));
  std::vector<SkinVertex> out;
  for (std::size_t j = 0; j < body.joints.size(); ++j) {
    for (int k = 0; k < 40; ++k) {
      SkinVertex v;
      v.p_in_world = rest[j].translation + dice.between(0.0, 0.2) * dice.direction();
      std::size_t at = j;
      double left = 1.0;
      for (std::size_t i = 0; i < 4; ++i) {
        v.joints[i] = static_cast<JointIndex>(at);
        v.weights[i] = i == 3 ? left : left * dice.between(0.0, 1.0);
        left -= v.weights[i];
        if (body.joints[at].parent) at = index(*body.joints[at].parent);
      }
      out.push_back(v);
    }
  }
  return out;
}

// Linear blend skinning as in the glTF specification.
double height_of(const SkinVertex& v,
                 const std::vector<RigidTransform>& rest,
                 const std::vector<RigidTransform>& now) {
  double y = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t j = index(v.joints[k]);
    y += v.weights[k] * (now[j] * (inverse(rest[j]) * v.p_in_world)).y;
  }
  return y;
}

TEST(Skin, FindsTheLowestPointOfEachPart) {
  testing::Dice dice(11);
  for (int round = 0; round < 20; ++round) {
    const Skeleton body = testing::with_random_axes(testing::random_humanoid(dice), dice);
    const BodyMap map = *map_body(body);
    const auto vertices = random_skin(body, dice);
    const Skin skin(body, map, vertices);
    EXPECT_EQ(skin.vertex_count(), vertices.size());
    Pose pose = rest_pose(body);
    for (glm::dquat& turn : pose.parent_from_joint) turn = turn * dice.turn(1.0);
    const auto rest = world_from_joints(body, rest_pose(body));
    const auto now = world_from_joints(body, pose);
    const auto parts = skin_parts(body, map);
    SkinLows wanted;
    wanted.fill(kNoSkin_m);
    for (const SkinVertex& v : vertices) {
      const auto heaviest = std::ranges::max_element(v.weights) - v.weights.begin();
      const SkinPart part = parts[index(v.joints[static_cast<std::size_t>(heaviest)])];
      wanted[index(part)] = std::min(wanted[index(part)], height_of(v, rest, now));
    }
    std::vector<glm::dvec4> rows(now.size());
    SkinLows lows{};
    skin.lows(now, 100.0, rows, lows);
    for (std::size_t p = 0; p < lows.size(); ++p) EXPECT_NEAR(lows[p], wanted[p], 1e-9);
    // With a ceiling, all points below it have the same accuracy.
    const double ceiling_m = now[0].translation.y - 0.3;
    skin.lows(now, ceiling_m, rows, lows);
    for (std::size_t p = 0; p < lows.size(); ++p) {
      if (wanted[p] < ceiling_m) {
        EXPECT_NEAR(lows[p], wanted[p], 1e-9);
      } else {
        EXPECT_GE(lows[p], ceiling_m);
      }
    }
  }
}

TEST(Skin, AllocatesNothingPerPosture) {
  testing::Dice dice(3);
  const Skeleton body = testing::giant();
  const Skin skin(body, *map_body(body), random_skin(body, dice));
  const auto now = world_from_joints(body, rest_pose(body));
  std::vector<glm::dvec4> rows(now.size());
  SkinLows lows{};
  const auto before = testing::allocations();
  for (int k = 0; k < 100; ++k) skin.lows(now, 0.1, rows, lows);
  EXPECT_EQ(testing::allocations(), before);
}

TEST(Skin, CountsFingersAndTwistsToTheirLimbAndLongChainsAsWorn) {
  Skeleton body = testing::giant();
  const auto add = [&](const char* name, JointIndex parent) {
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    body.joints.push_back(joint);
    return static_cast<JointIndex>(body.joints.size() - 1);
  };
  const JointIndex twist = add("twist", *body.find(HumanBone::kLeftUpperArm));
  const JointIndex finger = add("finger", *body.find(HumanBone::kRightHand));
  const JointIndex jaw = add("jaw", *body.find(HumanBone::kHead));
  JointIndex tail = add("tail0", *body.find(HumanBone::kHips));
  for (const char* name : {"tail1", "tail2", "tail3"}) tail = add(name, tail);
  const auto parts = skin_parts(body, *map_body(body));
  EXPECT_EQ(parts[index(twist)], SkinPart::kLeftUpperArm);
  EXPECT_EQ(parts[index(finger)], SkinPart::kRightHand);
  EXPECT_EQ(parts[index(jaw)], SkinPart::kHead);
  EXPECT_EQ(parts[index(tail)], SkinPart::kWorn);
}

}  // namespace
}  // namespace marey::retarget
