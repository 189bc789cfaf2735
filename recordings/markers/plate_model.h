// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "recordings/markers/c3d.h"
#include "recordings/markers/file_axes.h"

namespace marey::recordings {

/// A force plate as described in the file.
struct PlateModel {
  std::size_t number = 1;  ///< Number in the file, from 1.
  int type = 2;
  std::vector<std::size_t> channels;
  std::array<glm::dvec3, 4> corners_in_world{};
  glm::dvec3 centre_in_world{0.0};
  glm::dmat3 world_from_plate{1.0};  ///< z of the plate points into the floor.
  glm::dvec3 origin{
      0.0};  ///< For types 2 and 4: from the sensor to the surface's centre. [m]
  std::vector<double> matrix;  ///< For type 4: 6 x 6, column by column.
  /// Factor from the file's unit of moment per unit of force to metres.
  double metres_per_moment = 1e-3;
};

/// Returns the readable plates of a file. The reasons for unreadable plates are reported
/// in `notes`.
[[nodiscard]] std::vector<PlateModel> plate_models(const C3dInfo& info,
                                                   const FileAxes& axes,
                                                   std::vector<std::string>& notes);

}  // namespace marey::recordings
