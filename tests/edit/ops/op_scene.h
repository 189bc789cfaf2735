// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "edit/state/op_report.h"
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {

/// An operation with its surroundings, for tests of functions in edit/ops/.
template <class Op>
struct OpScene {
  EditOp op;
  EditInputs inputs;
  OpReport report;

  explicit OpScene(Op parameters) { op.parameters = std::move(parameters); }

  template <class Apply>
  [[nodiscard]] Result<EditState> run(const Apply& apply, const EditState& state) {
    report = {};
    return apply(std::get<Op>(op.parameters), OpContext{op, 0, inputs}, state, report);
  }

  /// Returns a figure of the report; NaN if it is missing.
  [[nodiscard]] double figure(std::string_view name) const {
    for (const auto& [key, value] : report.figures) {
      if (key == name) return value;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] bool has_finding(std::string_view id) const {
    for (const Finding& finding : report.findings) {
      if (finding.id == id) return true;
    }
    return false;
  }
};

/// Disturbs a motion by noise of this seed: each rotation and the root, per axis.
inline void add_motion_noise(Motion& motion,
                             std::uint64_t seed,
                             double noise_rad,
                             double noise_m) {
  testing::Dice dice(seed);
  for (Pose& pose : motion.poses) {
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q * rotation_from_vector(
                  {dice.noise(noise_rad), dice.noise(noise_rad), dice.noise(noise_rad)});
    }
    pose.root_in_world +=
        glm::dvec3(dice.noise(noise_m), dice.noise(noise_m), dice.noise(noise_m));
  }
}

/// Returns the places of one joint in the world.
inline std::vector<glm::dvec3> joint_way(const Motion& motion, HumanBone bone) {
  std::vector<glm::dvec3> out;
  for (const Pose& pose : motion.poses) {
    out.push_back(
        world_from_joints(motion.skeleton, pose)[index(*motion.skeleton.find(bone))]
            .translation);
  }
  return out;
}

/// Returns the flexion of a knee in each frame. [rad]
inline std::vector<double> knee_angles(const Motion& motion, int side) {
  const auto hip =
      joint_way(motion, side == 0 ? HumanBone::kLeftUpperLeg : HumanBone::kRightUpperLeg);
  const auto knee =
      joint_way(motion, side == 0 ? HumanBone::kLeftLowerLeg : HumanBone::kRightLowerLeg);
  const auto ankle =
      joint_way(motion, side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot);
  std::vector<double> out;
  for (std::size_t t = 0; t < hip.size(); ++t) {
    const glm::dvec3 a = glm::normalize(knee[t] - hip[t]);
    const glm::dvec3 b = glm::normalize(ankle[t] - knee[t]);
    out.push_back(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
  }
  return out;
}

/// Returns the largest speed of both knees' flexion. [rad/s]
inline double knee_speed(const Motion& motion) {
  double largest = 0.0;
  for (int side = 0; side < 2; ++side) {
    const auto angle = knee_angles(motion, side);
    for (std::size_t t = 1; t < angle.size(); ++t) {
      largest = std::max(largest, std::abs(angle[t] - angle[t - 1]) * motion.rate.hz);
    }
  }
  return largest;
}

}  // namespace marey::edit
