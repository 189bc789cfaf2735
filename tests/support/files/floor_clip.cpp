// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/floor_clip.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::testing {
namespace {

using B = HumanBone;

glm::dquat about(const glm::dvec3& axis, double degrees) {
  return glm::angleAxis(glm::radians(degrees), axis);
}

const glm::dvec3 kX(1, 0, 0);
const glm::dvec3 kZ(0, 0, 1);

struct Posture {
  Pose pose;
  glm::dquat& operator[](B bone) { return pose.parent_from_joint[index(bone)]; }
};

Posture standing(const Skeleton& body) {
  Posture out{rest_pose(body)};
  out[B::kLeftUpperArm] = about(kZ, -75.0);
  out[B::kRightUpperArm] = about(kZ, 75.0);
  return out;
}

std::vector<Posture> postures(const Skeleton& body) {
  std::vector<Posture> out(8, standing(body));
  Posture& kneeling = out[1];
  Posture& sitting = out[2];
  for (const B knee : {B::kLeftLowerLeg, B::kRightLowerLeg})
    kneeling[knee] = about(kX, 90.0);
  for (const B foot : {B::kLeftFoot, B::kRightFoot}) kneeling[foot] = about(kX, 75.0);
  for (const B hip : {B::kLeftUpperLeg, B::kRightUpperLeg})
    sitting[hip] = about(kX, -88.0);
  out[3][B::kHips] = about(kX, -90.0);
  out[4][B::kHips] = about(kX, 90.0);
  for (const std::size_t k : {4U, 5U, 6U}) {
    const double raised = k == 5 ? 10.0 : 85.0;
    out[k][B::kLeftUpperArm] = about(kZ, raised);
    out[k][B::kRightUpperArm] = about(kZ, -raised);
  }
  for (const B foot : {B::kLeftFoot, B::kRightFoot}) out[4][foot] = about(kX, 60.0);
  out[5][B::kHips] = about(kZ, 179.0);
  out[6][B::kHips] = about(kZ, 179.0);
  return out;
}

/// Sets the body on the floor: the lowest joint is above it by its soft tissue.
void set_down(const Skeleton& body, Pose& pose) {
  const auto frames = world_from_joints(body, pose);
  double lowest_m = 1e9;
  for (std::size_t j = 0; j < frames.size(); ++j) {
    const B bone = static_cast<B>(j);
    const bool is_ankle = bone == B::kLeftFoot || bone == B::kRightFoot;
    const bool is_toe = bone == B::kLeftToes || bone == B::kRightToes;
    const double soft_tissue_m = is_toe             ? 0.018
                                 : is_ankle         ? 0.068
                                 : bone == B::kHips ? 0.1
                                                    : 0.05;
    lowest_m = std::min(lowest_m, frames[j].translation.y - soft_tissue_m);
    if (const auto& tip = body.joints[j].tip_in_joint; tip && !is_toe) {
      lowest_m = std::min(lowest_m, (frames[j] * *tip).y - 0.005);
    }
  }
  pose.root_in_world.y -= lowest_m;
}

Pose between(const Pose& a, const Pose& b, double share) {
  Pose out = a;
  out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    out.parent_from_joint[j] =
        glm::slerp(a.parent_from_joint[j], b.parent_from_joint[j], share);
  }
  return out;
}

void write_joint(std::ofstream& out, const Skeleton& body, std::size_t j) {
  const Joint& joint = body.joints[j];
  const glm::dvec3 p =
      100.0 * (joint.parent ? joint.parent_from_joint.translation : glm::dvec3(0.0));
  out << (joint.parent ? "JOINT " : "ROOT ") << joint.name << "\n{\nOFFSET " << p.x << ' '
      << p.y << ' ' << p.z << '\n'
      << (joint.parent ? "CHANNELS 3 " : "CHANNELS 6 Xposition Yposition Zposition ")
      << "Zrotation Yrotation Xrotation\n";
  bool has_child = false;
  for (std::size_t k = j + 1; k < body.joints.size(); ++k) {
    if (body.joints[k].parent != static_cast<JointIndex>(j)) continue;
    has_child = true;
    write_joint(out, body, k);
  }
  if (!has_child) {
    const glm::dvec3 tip = 100.0 * joint.tip_in_joint.value_or(glm::dvec3(0.0));
    out << "End Site\n{\nOFFSET " << tip.x << ' ' << tip.y << ' ' << tip.z << "\n}\n";
  }
  out << "}\n";
}

void order_of(const Skeleton& body, std::size_t j, std::vector<std::size_t>& order) {
  order.push_back(j);
  for (std::size_t k = j + 1; k < body.joints.size(); ++k) {
    if (body.joints[k].parent == static_cast<JointIndex>(j)) order_of(body, k, order);
  }
}

}  // namespace

void write_floor_clip(const std::filesystem::path& path) {
  constexpr int kSteps = 45;
  const Skeleton body = make_humanoid(average_proportions(1.75));
  std::vector<Pose> frames;
  const auto key = postures(body);
  for (std::size_t k = 0; k + 1 < key.size(); ++k) {
    for (int i = 0; i < kSteps; ++i) {
      const double share = std::clamp(1.5 * i / kSteps - 0.25, 0.0, 1.0);
      Pose pose =
          between(key[k].pose, key[k + 1].pose, share * share * (3.0 - 2.0 * share));
      set_down(body, pose);
      frames.push_back(std::move(pose));
    }
  }
  std::ofstream out(path);
  out.precision(9);
  out << "HIERARCHY\n";
  write_joint(out, body, 0);
  out << "MOTION\nFrames: " << frames.size() << "\nFrame Time: 0.0333333333\n";
  std::vector<std::size_t> order;
  order_of(body, 0, order);
  for (const Pose& pose : frames) {
    const glm::dvec3 root = 100.0 * pose.root_in_world;
    out << root.x << ' ' << root.y << ' ' << root.z;
    for (const std::size_t j : order) {
      const glm::dmat3 m = glm::mat3_cast(pose.parent_from_joint[j]);
      // Rz Ry Rx.
      const double y = std::asin(std::clamp(-m[0][2], -1.0, 1.0));
      out << ' ' << glm::degrees(std::atan2(m[0][1], m[0][0])) << ' ' << glm::degrees(y)
          << ' ' << glm::degrees(std::atan2(m[1][2], m[2][2]));
    }
    out << '\n';
  }
  if (!out) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace marey::testing
