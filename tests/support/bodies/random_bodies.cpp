// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bodies/random_bodies.h"

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/human/average_proportions.h"

namespace marey::testing {
namespace {

using B = HumanBone;

// The joints' rest frames in the world decide the skeleton.
void set_rest(Skeleton& skeleton, const std::vector<RigidTransform>& world_from_joint) {
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    Joint& joint = skeleton.joints[i];
    joint.parent_from_joint =
        joint.parent
            ? inverse(world_from_joint[index(*joint.parent)]) * world_from_joint[i]
            : world_from_joint[i];
  }
}

std::vector<RigidTransform> rest_frames(const Skeleton& skeleton) {
  return world_from_joints(skeleton, rest_pose(skeleton));
}

std::size_t at(const Skeleton& skeleton, B bone) {
  const auto joint = skeleton.find(bone);
  MAREY_ASSERT(joint.has_value());
  return index(*joint);
}

// Removes joint `gone`. Its children become children of its parent.
Skeleton without_joint(const Skeleton& skeleton, std::size_t gone) {
  Skeleton out;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    if (i == gone) continue;
    Joint joint = skeleton.joints[i];
    if (joint.parent && index(*joint.parent) == gone) {
      joint.parent = skeleton.joints[gone].parent;
      joint.parent_from_joint =
          skeleton.joints[gone].parent_from_joint * joint.parent_from_joint;
    }
    if (joint.parent && index(*joint.parent) > gone) {
      joint.parent = JointIndex{static_cast<int>(index(*joint.parent)) - 1};
    }
    out.joints.push_back(std::move(joint));
  }
  return out;
}

Skeleton standing(Proportions p) {
  // The soles on Y = 0: the toe joints a little above it.
  const double toes = p[B::kHips].y + p[B::kLeftUpperLeg].y + p[B::kLeftLowerLeg].y +
                      p[B::kLeftFoot].y + p[B::kLeftToes].y;
  p[B::kHips].y += 0.02 * p[B::kHips].y - toes;
  return make_humanoid(p);
}

}  // namespace

double Dice::between(double low, double high) {
  const double unit = static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  return low + (high - low) * unit;
}

glm::dvec3 Dice::direction() {
  const double z = between(-1, 1);
  const double a = between(0, 6.283185307179586);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

glm::dquat Dice::turn(double max_rad) {
  return glm::angleAxis(between(0, max_rad), direction());
}

double Dice::noise(double sigma) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += between(-0.5, 0.5);
  return sigma * sum;
}

Skeleton random_humanoid(Dice& dice) {
  Proportions p = average_proportions(dice.between(1.0, 2.5));
  for (const B bone : human_bones()) {
    const double factor = dice.between(0.75, 1.3);
    p[bone] *= factor;
    p[bone] += 0.05 * factor * glm::length(p[bone]) * dice.direction();
  }
  p[B::kHips].x = 0;
  return standing(p);
}

Skeleton child() {
  Proportions p = average_proportions(1.1);
  for (const B bone :
       {B::kLeftLowerArm, B::kLeftHand, B::kRightLowerArm, B::kRightHand}) {
    p[bone] *= 1.2;
  }
  return standing(p);
}

Skeleton giant() {
  return standing(average_proportions(2.5));
}

Skeleton long_legs() {
  Proportions p = average_proportions(1.75);
  for (const B bone :
       {B::kLeftLowerLeg, B::kLeftFoot, B::kRightLowerLeg, B::kRightFoot}) {
    p[bone] *= 1.2;
  }
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck}) p[bone] *= 0.8;
  return standing(p);
}

Skeleton with_random_axes(const Skeleton& skeleton, Dice& dice) {
  Skeleton out = skeleton;
  std::vector<RigidTransform> frames = rest_frames(skeleton);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const glm::dquat turn = dice.turn(3.0);
    if (auto& tip = out.joints[i].tip_in_joint) tip = glm::conjugate(turn) * *tip;
    frames[i].rotation = frames[i].rotation * turn;
  }
  set_rest(out, frames);
  return out;
}

Skeleton in_a_pose(const Skeleton& t_pose, double down_rad) {
  Pose pose = rest_pose(t_pose);
  const glm::dvec3 forward(0, 0, 1);
  const auto turn = [&](B bone, double angle) {
    auto& rotation = pose.parent_from_joint[at(t_pose, bone)];
    rotation = glm::angleAxis(angle, forward) * rotation;
  };
  turn(B::kLeftUpperArm, -down_rad);
  turn(B::kRightUpperArm, down_rad);
  turn(B::kLeftUpperLeg, 0.5 * down_rad);
  turn(B::kRightUpperLeg, -0.5 * down_rad);
  turn(B::kLeftFoot, -0.5 * down_rad);
  turn(B::kRightFoot, 0.5 * down_rad);
  std::vector<RigidTransform> frames = world_from_joints(t_pose, pose);
  const double sunk_m = frames[at(t_pose, B::kLeftFoot)].translation.y -
                        rest_frames(t_pose)[at(t_pose, B::kLeftFoot)].translation.y;
  for (RigidTransform& frame : frames) frame.translation.y -= sunk_m;
  Skeleton out = t_pose;
  set_rest(out, frames);
  return out;
}

Skeleton without(const Skeleton& skeleton, B bone) {
  return without_joint(skeleton, at(skeleton, bone));
}

Skeleton with_vertebrae(const Skeleton& skeleton, int count) {
  const auto frames = rest_frames(skeleton);
  const glm::dvec3 hips = frames[at(skeleton, B::kHips)].translation;
  const glm::dvec3 neck = frames[at(skeleton, B::kNeck)].translation;
  Skeleton out;
  std::vector<RigidTransform> out_frames;
  std::vector<std::optional<JointIndex>> place(skeleton.joints.size());
  const auto last_vertebra = JointIndex{count};
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    Joint joint = skeleton.joints[i];
    if (joint.bone == B::kSpine) {
      for (int k = 1; k <= count; ++k) {
        Joint vertebra;
        vertebra.name = "vertebra" + std::to_string(k);
        vertebra.parent = JointIndex{k - 1};
        out_frames.push_back(
            {{1, 0, 0, 0},
             hips + (neck - hips) * (static_cast<double>(k) / (count + 1))});
        out.joints.push_back(vertebra);
      }
    }
    if (joint.bone == B::kSpine || joint.bone == B::kChest ||
        joint.bone == B::kUpperChest) {
      place[i] = last_vertebra;
      continue;
    }
    place[i] = JointIndex{static_cast<int>(out.joints.size())};
    if (joint.parent) joint.parent = place[index(*joint.parent)];
    out_frames.push_back(frames[i]);
    out.joints.push_back(std::move(joint));
  }
  set_rest(out, out_frames);
  return out;
}

Skeleton with_extra_joints(const Skeleton& skeleton) {
  Skeleton out;
  std::vector<JointIndex> place;
  for (const Joint& original : skeleton.joints) {
    Joint joint = original;
    if (joint.parent) joint.parent = place[index(*joint.parent)];
    if (joint.bone == B::kLeftLowerArm) {
      Joint twist;
      twist.name = "twist";
      twist.parent = joint.parent;
      twist.parent_from_joint = {glm::angleAxis(0.3, glm::dvec3(0, 0, 1)),
                                 0.5 * joint.parent_from_joint.translation};
      joint.parent_from_joint =
          inverse(twist.parent_from_joint) * joint.parent_from_joint;
      joint.parent = JointIndex{static_cast<int>(out.joints.size())};
      out.joints.push_back(twist);
    }
    place.push_back(JointIndex{static_cast<int>(out.joints.size())});
    out.joints.push_back(joint);
    if (joint.bone == B::kLeftHand || joint.bone == B::kRightHand) {
      Joint finger;
      finger.name = joint.name + "Finger";
      finger.parent = place.back();
      finger.parent_from_joint.translation = {0.08, 0.0, 0.01};
      out.joints.push_back(finger);
    }
  }
  return out;
}

Skeleton mirrored_body(const Skeleton& skeleton) {
  Skeleton out = skeleton;
  for (Joint& joint : out.joints) {
    joint.parent_from_joint.translation.x *= -1.0;
    if (joint.tip_in_joint) joint.tip_in_joint->x *= -1.0;
    if (!joint.bone) continue;
    joint.bone = mirrored(*joint.bone);
    joint.name = std::string(name(*joint.bone));
  }
  return out;
}

Pose random_pose(const Skeleton& skeleton, Dice& dice) {
  Pose pose = rest_pose(skeleton);
  pose.root_in_world +=
      glm::dvec3(dice.between(-2, 2), dice.between(-0.4, 0.5), dice.between(-2, 2));
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const bool vertebra = joint.name.starts_with("vertebra");
    if (!joint.bone && !vertebra) continue;
    double max_rad = vertebra ? 0.25 : 0.7;
    if (joint.bone == B::kHips) max_rad = 3.0;
    for (const HumanLimb& limb : human_limbs()) {
      if (joint.bone == limb.upper) max_rad = 1.6;
      if (joint.bone == limb.lower) max_rad = 2.6;
    }
    pose.parent_from_joint[i] = pose.parent_from_joint[i] * dice.turn(max_rad);
  }
  return pose;
}

}  // namespace marey::testing
