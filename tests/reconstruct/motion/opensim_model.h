// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/motion/joint_angles.h"

namespace marey::testing {

/// In the coordinates' order. [rad], [m]
using Angles = std::array<double, reconstruct::kCoordinateCount>;

/// Returns the coordinate of this name. Precondition: it exists.
[[nodiscard]] reconstruct::Coordinate coordinate(const std::string& name);

/// Poses a skeleton as OpenSim poses Rajagopal2016: joint by joint, with the axes of the
/// model's file on both sides. World axes are the ground's; the pelvis' translation is
/// ignored.
class Model {
 public:
  explicit Model(const Angles& angles);

  [[nodiscard]] Pose pose(const Skeleton& skeleton, const glm::dvec3& root) const {
    return pose_from_world(skeleton, root, world_from_bone_);
  }
  [[nodiscard]] const glm::dquat& ground_from_pelvis() const { return pelvis_; }

 private:
  [[nodiscard]] double of(const std::string& name) const;
  [[nodiscard]] glm::dquat ball(const std::array<std::string, 3>& names,
                                double side) const;
  void put(HumanBone bone, const glm::dquat& world_from_bone);
  void leg(bool left);
  void arm(const glm::dquat& torso, bool left);

  Angles angles_;
  glm::dquat pelvis_{1, 0, 0, 0};
  std::array<glm::dquat, kHumanBoneCount> world_from_bone_{};
};

}  // namespace marey::testing
