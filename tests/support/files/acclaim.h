// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/transform.h"

namespace marey::testing {

/// A bone of an Acclaim skeleton. The first is the root, which has no length.
struct AcclaimBone {
  std::string name;
  std::optional<std::size_t> parent;  ///< nullopt only for the root.
  glm::dvec3 span_in_root{0.0};       ///< From its start to its end at rest. [m]
  /// The bone's own axes at rest, about which its angles turn.
  glm::dquat root_from_axes{1.0, 0.0, 0.0, 0.0};
  /// Channels of the bone in a motion: 'x', 'y', 'z' turn about the axis, in this order.
  /// 'X', 'Y', 'Z' move along it.
  std::string channels;
};

/// The studio's skeleton, as in CMU's ASF files. Angles are in degrees. A length of 1 is
/// 1/0.45 of an inch where the file has `length 0.45`.
struct AcclaimSkeleton {
  std::vector<AcclaimBone> bones;  ///< Parents first.
  double unit_m = 0.0;             ///< Unit of lengths in the motion.

  [[nodiscard]] std::optional<std::size_t> find(std::string_view bone) const;
};

/// Reads the parts of an ASF file that the motions of CMU's database need. The order of
/// angles is XYZ, and they are in degrees. Returns an error with the line for other
/// files.
[[nodiscard]] Result<AcclaimSkeleton> parse_asf(const std::string& text,
                                                const std::string& file);

/// The numbers of each frame, in the order of the bones and their channels. [rad], [m]
[[nodiscard]] Result<std::vector<std::vector<double>>> parse_amc(
    const AcclaimSkeleton& skeleton, const std::string& text, const std::string& file);

/// Returns the start of each bone and its rotation away from rest, in the frame of the
/// file (Y up). The origin of a bone's own frame is its start.
[[nodiscard]] std::vector<RigidTransform> file_from_bones(
    const AcclaimSkeleton& skeleton, const std::vector<double>& frame);

}  // namespace marey::testing
