// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"

namespace marey::testing {

/// The true place of a joint, by frame. World metres, Y up.
using TruthJoints = std::map<std::pair<int, HumanBone>, glm::dvec3>;

/// The twelve joints of the limbs (shoulder, elbow, wrist, hip, knee and ankle, left and
/// right) of a rendered recording, from its truth/joints.csv: Z up there, Y up here.
/// Joints of other names are passed over. nullopt when the file is not there or not such
/// a table.
[[nodiscard]] std::optional<TruthJoints> truth_joints(const std::filesystem::path& csv);

/// The true rotation of a segment of the body, by frame: from the segment's axes to a
/// world that is Y up.
using TruthRotations = std::map<std::pair<int, HumanBone>, glm::dquat>;

/// The fifteen segments that wear tags (hips, chest, head, and three of each limb) of a
/// rendered recording, from its truth/segments.csv. The axes are the recording's own: in
/// its zero pose, which is not quite marey's T-pose, those of the world. Other segments
/// are passed over. nullopt when the file is not there or not such a table.
[[nodiscard]] std::optional<TruthRotations> truth_rotations(
    const std::filesystem::path& csv);

/// A camera of a rendered recording.
struct TruthCamera {
  std::string name;
  glm::dvec2 focal_px{0.0};
  glm::dvec3 centre_in_world{0.0};  ///< [m], Y up.
  double offset_s = 0.0;            ///< Frame k was exposed at k / fps + offset.
};

/// Reads the cameras of truth/cameras.json; nullopt when the file is missing or invalid.
[[nodiscard]] std::optional<std::vector<TruthCamera>> truth_cameras(
    const std::filesystem::path& json);

}  // namespace marey::testing
