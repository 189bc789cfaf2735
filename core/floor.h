// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace marey {

/// Displacement of a part of a floor at one time, relative to its place in the file.
struct FloorKey {
  double time_s = 0.0;
  glm::dvec3 moved_m{0.0};  ///< World axes.
};

/// A step, a platform or a ramp: a rectangle along the world's axes with a plane on top.
/// It has no sides: the height is discontinuous at its edges.
struct FloorPart {
  std::string name;
  glm::dvec2 min_xz_m{0.0};  ///< World X and Z, unmoved; below max_xz_m.
  glm::dvec2 max_xz_m{0.0};
  /// Height of its top in the middle, above the motion's floor.
  double height_m = 0.0;
  glm::dvec2 slope{0.0};       ///< Rise per metre towards +X and +Z.
  std::vector<FloorKey> path;  ///< Times ascending; empty: it does not move.
};

/// The ground under the feet (Kulpa 2005, 4.2.4): the highest of the parts at a place; a
/// plane where there is none. Heights are above the floor on which a motion was made.
struct Floor {
  double base_height_m = 0.0;
  std::vector<FloorPart> parts;
};

/// Index of a part; nullopt is the base.
using FloorPartIndex = std::optional<std::size_t>;

}  // namespace marey
