// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/planar_match.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/edit/edit_ops.h"

namespace marey::edit {

/// The planar motion at constant speed and turn (a screw about the vertical) that is the
/// identity at share 0 and `travel` at share 1. Shares may lie outside of 0 to 1.
/// Precondition: a turn of less than a full one.
class CycleScrew {
 public:
  explicit CycleScrew(const PlanarMove& travel);
  [[nodiscard]] PlanarMove at(double share) const;

 private:
  double turn_rad_;
  glm::dvec2 speed_{0.0};
};

/// The paths on which a cycle lies before and after it is made a loop, over shares of the
/// cycle. Both agree at share 1/2.
class CyclePaths {
 public:
  /// `centre` is the mean place of the body in the screw's frame. The straight path is as
  /// long as the way of this point on the screw.
  CyclePaths(const PlanarMove& travel, CycleDrift drift, const glm::dvec3& centre);

  [[nodiscard]] PlanarMove old_path(double share) const { return screw_.at(share); }
  [[nodiscard]] PlanarMove new_path(double share) const;
  /// Moves a cycle to the next one on the new path.
  [[nodiscard]] PlanarMove step() const { return new_path(1.0) * inverse(new_path(0.0)); }
  /// Moves a frame to where its cycle started.
  [[nodiscard]] PlanarMove in_place(double share) const {
    return new_path(0.0) * inverse(new_path(share));
  }

 private:
  CycleScrew screw_;
  PlanarMove middle_;
  glm::dvec2 line_m_{0.0};
  bool keeps_;
};

}  // namespace marey::edit
