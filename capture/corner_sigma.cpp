// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "capture/detect_tags.h"
#include "core/assert.h"

// Both laws were fitted to rendered 720p video with known corners (noise of 2 grey
// levels, lens blur of 0.4 to 0.5 px, H.264): 18000 sightings of tags of 14 to 35 px.
// Root mean square of a coordinate, in px, at a side of
//                                         14     18     22     26     30
//   along edges, shrinkage taken off     0.26   0.15   0.13   0.11   0.11
//   law                                  0.24   0.16   0.13   0.12   0.11
//   aligned patterns                     0.10   0.09   0.08   0.07   0.07
//   law                                  0.10   0.09   0.08   0.08   0.07
// Most of it is not noise: a tag at rest keeps its error from frame to frame.
namespace marey::capture {

double edge_corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  const double small = 6.5 / side_px;
  return std::hypot(0.1, small * small);
}

double aligned_corner_sigma_px(double side_px, double blur_px) {
  MAREY_ASSERT(side_px > 0.0 && blur_px >= 0.0);
  // An edge's place is the less certain the wider it is smeared: 0.085 px below a blur of
  // 0.7 px, 0.11 at 0.75, 0.14 at 0.9.
  constexpr double kSharpPx = 0.6;
  return std::max(1.0, blur_px / kSharpPx) * std::hypot(0.04, 0.34 / std::sqrt(side_px));
}

}  // namespace marey::capture
