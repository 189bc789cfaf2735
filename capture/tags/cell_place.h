// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

// Private to capture.
namespace marey::capture {

/// Position of a pixel in the cells of a tag.
struct Place {
  double u = 0.0;  ///< From the tag's middle. [cells]
  double v = 0.0;
  double depth = 1.0;   ///< Third homogeneous coordinate, from cells to image.
  double u_by_x = 0.0;  ///< [cells/px]
  double u_by_y = 0.0;
  double v_by_x = 0.0;
  double v_by_y = 0.0;
};

/// Returns the position of pixel `x`, `y`, relative to the image origin of
/// `image_from_cell`.
/// Precondition: the second matrix is the inverse of the first.
[[nodiscard]] inline Place place_of(const cv::Matx33d& image_from_cell,
                                    const cv::Matx33d& cell_from_image,
                                    double x,
                                    double y) {
  const cv::Matx33d& g = cell_from_image;
  const cv::Matx33d& h = image_from_cell;
  const double w = 1.0 / (g(2, 0) * x + g(2, 1) * y + g(2, 2));
  Place at;
  at.u = w * (g(0, 0) * x + g(0, 1) * y + g(0, 2));
  at.v = w * (g(1, 0) * x + g(1, 1) * y + g(1, 2));
  at.depth = h(2, 0) * at.u + h(2, 1) * at.v + h(2, 2);
  // Derivatives of image by cell coordinates, times the depth; their inverse.
  const double x_by_u = h(0, 0) - h(2, 0) * x;
  const double x_by_v = h(0, 1) - h(2, 1) * x;
  const double y_by_u = h(1, 0) - h(2, 0) * y;
  const double y_by_v = h(1, 1) - h(2, 1) * y;
  const double scale = at.depth / (x_by_u * y_by_v - x_by_v * y_by_u);
  at.u_by_x = y_by_v * scale;
  at.u_by_y = -x_by_v * scale;
  at.v_by_x = -y_by_u * scale;
  at.v_by_y = x_by_u * scale;
  return at;
}

}  // namespace marey::capture
