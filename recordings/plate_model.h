// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "recordings/c3d.h"
#include "recordings/file_axes.h"

namespace marey::recordings {

/// A plate as the file describes it.
struct PlateModel {
  std::size_t number = 1;  ///< In the file, from 1.
  int type = 2;
  std::vector<std::size_t> channels;
  std::array<glm::dvec3, 4> corners_in_world{};
  glm::dvec3 centre_in_world{0.0};
  glm::dmat3 world_from_plate{1.0};  ///< Plate: z into the floor.
  glm::dvec3 origin{
      0.0};  ///< Of types 2 and 4 from the sensor to the surface's centre. [m]
  std::vector<double> matrix;       ///< Of type 4: 6 x 6, column by column.
  double metres_per_moment = 1e-3;  ///< Of a unit of moment over one of force.
};

/// The plates of a file that can be read; why others cannot is told in `notes`.
[[nodiscard]] std::vector<PlateModel> plate_models(const C3dInfo& info,
                                                   const FileAxes& axes,
                                                   std::vector<std::string>& notes);

}  // namespace marey::recordings
