// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace marey {

/// Where a part of a floor is at one time, from where its file puts it.
struct FloorKey {
  double time_s = 0.0;
  glm::dvec3 moved_m{0.0};  ///< World axes.
};

/// A step, a platform or a ramp: a rectangle along the world's axes with a plane on top.
/// It has no sides: at its edges the floor changes its height at once.
struct FloorPart {
  std::string name;
  glm::dvec2 min_xz_m{0.0};  ///< World X and Z, unmoved; below max_xz_m.
  glm::dvec2 max_xz_m{0.0};
  double height_m = 0.0;       ///< Of its top, in the middle; from the motion's floor.
  glm::dvec2 slope{0.0};       ///< Rise per metre towards +X and +Z.
  std::vector<FloorKey> path;  ///< Times ascending; empty: it does not move.
};

/// What feet stand on (Kulpa 2005, 4.2.4): the highest of the parts that are at a place;
/// where there is none, a plane. Heights are from the floor on which a motion was made.
struct Floor {
  double base_height_m = 0.0;
  std::vector<FloorPart> parts;
};

/// The index of a part; nullopt is the base.
using FloorPartIndex = std::optional<std::size_t>;

}  // namespace marey
