// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "capture/align_pattern.h"
#include "capture/detect_tags.h"
#include "core/assert.h"

// Both laws were fitted to rendered 720p video with known corners (noise of 2 grey
// levels, lens blur of 0.4 to 0.5 px, H.264): 18000 and 56000 corners of tags of 12 to
// 35 px.
namespace marey::capture {

// Root mean square of a coordinate, its shrinkage taken off, in px, at a side of
//             14     18     22     26     30
//   found    0.26   0.15   0.13   0.11   0.11
//   law      0.24   0.16   0.13   0.12   0.11
double edge_corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  const double small = 6.5 / side_px;
  return std::hypot(0.1, small * small);
}

// An edge is averaged over as many pixels as it is long. Of aligned tags, as above:
//             14     18     22     26
//   found    0.096  0.089  0.088  0.078
//   law      0.104  0.092  0.083  0.076
double expected_corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  return 0.39 / std::sqrt(side_px);
}

// Of each fit's own noise, in px, and what was found:
//   noise    0.023   0.038   0.052   0.061   0.070   0.079   0.104
//   found    0.037   0.072   0.086   0.094   0.100   0.118   0.146
double aligned_corner_sigma_px(double noise_px,
                               double residual,
                               double blur_px,
                               double white) {
  MAREY_ASSERT(noise_px >= 0.0 && residual >= 0.0 && blur_px > 0.0 && white >= 0.0);
  // Neighbouring pixels err together, by compression above all: so the noise counts for
  // more than that of as many pixels, and some of it moves a whole edge.
  constexpr double kNoise = 1.4;
  constexpr double kEdge = 0.9;
  // A pixel is a box; where that is most of the blur, a Gaussian is not its shape. Where
  // white is clipped, only the lower part of each edge is seen, and the shape matters
  // more. From drawn tags, upright ones being worst.
  constexpr double kShapePx = 0.05;
  constexpr double kClippedPx = 0.055;
  const double shape_px = kShapePx * std::min(1.0, 1.0 / (12.0 * blur_px * blur_px));
  const double clipped_px = white > 1.0 ? kClippedPx * white : 0.0;
  // All edges between two pixels: nothing says where, but it is within one.
  constexpr double kMostNoisePx = 0.3;
  return std::hypot(kNoise * std::min(noise_px, kMostNoisePx),
                    kEdge * residual * blur_px,
                    std::hypot(shape_px, clipped_px));
}

}  // namespace marey::capture
