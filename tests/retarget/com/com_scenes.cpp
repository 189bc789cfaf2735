// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/com/com_scenes.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "retarget/body/place_masses.h"
#include "retarget/com/foot_goals.h"
#include "tests/retarget/mapped.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// A joint without a bone halfway along each thigh; the shank hangs on it.
Skeleton with_thigh_twists(const Skeleton& skeleton) {
  Skeleton out;
  std::vector<JointIndex> place;
  for (const Joint& original : skeleton.joints) {
    Joint joint = original;
    if (joint.parent) joint.parent = place[index(*joint.parent)];
    if (joint.bone == B::kLeftLowerLeg || joint.bone == B::kRightLowerLeg) {
      Joint twist;
      twist.name = joint.name + "Twist";
      twist.parent = joint.parent;
      twist.parent_from_joint.translation = 0.5 * joint.parent_from_joint.translation;
      joint.parent_from_joint.translation *= 0.5;
      joint.parent = JointIndex{static_cast<int>(out.joints.size())};
      out.joints.push_back(twist);
    }
    place.push_back(JointIndex{static_cast<int>(out.joints.size())});
    out.joints.push_back(joint);
  }
  return out;
}

}  // namespace

HeavyBody heavy(Skeleton skeleton) {
  HeavyBody out{std::move(skeleton), {}, {}};
  out.map = mapped(out.skeleton);
  auto masses = place_masses(out.skeleton, out.map, {});
  EXPECT_TRUE(masses);
  if (masses) out.masses = *std::move(masses);
  return out;
}

HeavyBody heavy_body(std::uint64_t seed) {
  testing::Dice dice(seed);
  Skeleton skeleton = seed % 3 == 0
                          ? make_humanoid(average_proportions(dice.between(0.6, 2.5)))
                          : testing::random_humanoid(dice);
  if (seed % 4 == 1) {
    skeleton = testing::without(skeleton, B::kLeftToes);
    skeleton = testing::without(skeleton, B::kRightToes);
  }
  if (seed % 5 == 2) skeleton = with_thigh_twists(testing::with_extra_joints(skeleton));
  if (seed % 2 == 1) skeleton = testing::with_random_axes(skeleton, dice);
  return heavy(std::move(skeleton));
}

Pose squatting(const HeavyBody& body, double squat, testing::Dice& dice) {
  // Turns are given in world axes of the T-pose and conjugated into joint frames.
  const Skeleton& skeleton = body.skeleton;
  Pose pose = rest_pose(skeleton);
  const auto rest = world_from_joints(skeleton, pose);
  const auto turn = [&](JointIndex joint, const glm::dquat& by) {
    const auto& parent = skeleton[joint].parent;
    const glm::dquat above =
        parent ? rest[index(*parent)].rotation : glm::dquat(1, 0, 0, 0);
    pose.parent_from_joint[index(joint)] =
        glm::conjugate(above) * by * rest[index(joint)].rotation;
  };
  const glm::dvec3 x(1, 0, 0);
  for (int side = 0; side < 2; ++side) {
    const LimbMap& leg = body.map.leg(side);
    const double knee = squat * dice.between(0.8, 1.2);
    const double hip = -0.5 * knee + dice.between(-0.1, 0.1);
    turn(leg.upper, glm::angleAxis(hip, x) * dice.turn(0.15));
    turn(leg.lower, glm::angleAxis(knee, x));
    turn(leg.end, glm::angleAxis(-hip - knee, x) * dice.turn(0.1));
  }
  for (const B bone : {B::kSpine,
                       B::kChest,
                       B::kNeck,
                       B::kLeftUpperArm,
                       B::kRightUpperArm,
                       B::kLeftLowerArm,
                       B::kRightLowerArm}) {
    if (const auto joint = skeleton.find(bone)) turn(*joint, dice.turn(0.5));
  }
  const glm::dquat heading = glm::angleAxis(dice.between(-3.0, 3.0), glm::dvec3(0, 1, 0));
  pose.parent_from_joint[0] = heading * pose.parent_from_joint[0];
  pose.root_in_world += glm::dvec3(dice.between(-2, 2), 0.0, dice.between(-2, 2));
  double lowest_m = 1e9;
  for (int side = 0; side < 2; ++side) {
    lowest_m = std::min(lowest_m, body.place(pose, body.map.leg(side).end).y);
  }
  pose.root_in_world.y -= lowest_m - body.map.feet[0].ankle_height_m;
  return pose;
}

std::array<FootGoal, 2> own_feet(const HeavyBody& body,
                                 const Pose& pose,
                                 double hold,
                                 double heel_may_rise) {
  const Motion motion{body.skeleton, {60.0}, 0, {pose}};
  std::array<FootGoal, 2> out;
  for (int side = 0; side < 2; ++side) {
    out[static_cast<std::size_t>(side)] = {
        foot_places(motion, body.map, side)[0], hold, heel_may_rise};
  }
  return out;
}

Followed followed(const HeavyBody& body,
                  const Pose& reference,
                  const glm::dvec3& com_in_world,
                  const std::array<FootGoal, 2>& feet) {
  Followed out;
  const ComPlan plan{std::span(&reference, 1),
                     std::span(&com_in_world, 1),
                     {std::span(&feet[0], 1), std::span(&feet[1], 1)}};
  out.report = follow_com(body.follower(), plan, std::span(&out.pose, 1));
  return out;
}

double stretched_m(const HeavyBody& body, const Pose& pose) {
  const auto joints = world_from_joints(body.skeleton, pose);
  double worst = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = body.skeleton.joints[i];
    const glm::dquat& turn = pose.parent_from_joint[i];
    worst = std::max(worst, std::abs(glm::dot(turn, turn) - 1.0));
    if (!joint.parent) continue;
    const double now =
        glm::distance(joints[i].translation, joints[index(*joint.parent)].translation);
    worst =
        std::max(worst, std::abs(now - glm::length(joint.parent_from_joint.translation)));
  }
  return worst;
}

double extension(const HeavyBody& body, const Pose& pose, int side) {
  const LimbMap& leg = body.map.leg(side);
  return glm::distance(body.place(pose, leg.upper), body.place(pose, leg.end)) /
         leg.length_m();
}

double moved_m(const HeavyBody& body, const Pose& a, const Pose& b) {
  const auto from = world_from_joints(body.skeleton, a);
  const auto to = world_from_joints(body.skeleton, b);
  double worst = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    worst = std::max(worst, glm::distance(from[i].translation, to[i].translation));
  }
  return worst;
}

}  // namespace marey::retarget
