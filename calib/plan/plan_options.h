// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace marey::calib {

/// Returns the standard deviation [px] of a coordinate of a tag's corner as the detector
/// achieves it. `side_px` is the mean length of the tag's sides. More than 0.
using CornerSigma = std::function<double(double side_px)>;

/// Conditions under which a camera sees a tag, and the orientations of tags.
struct PlanOptions {
  double tag_size_m = 0.08;  ///< Edge of the black square.
  /// Between a tag's normal and the line of sight: 65 degrees.
  double max_angle_rad = 1.134;
  /// Smallest side of a tag: half of the tags of this size are detected
  /// (docs/accuracy/README.md).
  double min_side_px = 15.0;
  double lever_m = 0.15;  ///< From a tag to the joint whose position it determines.
  int directions = 36;    ///< Horizontal directions of tags, evenly spaced.
};

}  // namespace marey::calib
