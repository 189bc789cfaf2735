// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/angle_table.h"

#include <cmath>
#include <utility>

#include "core/humanoid.h"
#include "reconstruct/motion/joint_angles.h"

namespace marey::app {
namespace {

bool is_as_ours(const Skeleton& skeleton) {
  for (const HumanBone bone : human_bones()) {
    if (!skeleton.find(bone)) return false;
  }
  for (const Joint& joint : skeleton.joints) {
    if (std::abs(joint.parent_from_joint.rotation.w) < 1.0 - 1e-12) return false;
  }
  return true;
}

}  // namespace

std::optional<recordings::MotTable> angle_table(const Motion& motion, std::string name) {
  if (!is_as_ours(motion.skeleton)) return std::nullopt;
  recordings::MotTable table;
  table.name = std::move(name);
  for (std::size_t c = 0; c < reconstruct::kCoordinateCount; ++c) {
    const auto coordinate = static_cast<reconstruct::Coordinate>(c);
    table.columns.push_back(
        {std::string(reconstruct::name(coordinate)), reconstruct::is_angle(coordinate)});
  }
  reconstruct::JointAngles angles = reconstruct::joint_angles(motion);
  table.time_s = std::move(angles.time_s);
  table.values = std::move(angles.values);
  return table;
}

}  // namespace marey::app
