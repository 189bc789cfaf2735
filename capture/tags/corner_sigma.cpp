// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/corner_sigma.h"

#include <algorithm>
#include <cmath>

#include "capture/tags/align_pattern.h"
#include "core/base/assert.h"

// Both laws were fitted to rendered 720p video with known corners (noise of 2 grey
// levels, lens blur of 0.4 to 0.5 px, H.264): 18000 and 56000 corners of tags of 12 to
// 35 px.
namespace marey::capture {

// Root mean square error of a coordinate, its shrinkage corrected, in px, by side in px:
//               14     18     22     26     30
//     measured 0.26   0.15   0.13   0.11   0.11
//     model    0.24   0.16   0.13   0.12   0.11
double edge_corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  const double small = 6.5 / side_px;
  return std::hypot(0.1, small * small);
}

// An edge is averaged over as many pixels as it is long. Aligned tags, as above:
//               14     18     22     26
//     measured 0.096  0.089  0.088  0.078
//     model    0.104  0.092  0.083  0.076
double expected_corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  return 0.39 / std::sqrt(side_px);
}

// Noise of each fit and measured error, in px:
//     noise    0.023   0.038   0.052   0.061   0.070   0.079   0.104
//     measured 0.037   0.072   0.086   0.094   0.100   0.118   0.146
double aligned_corner_sigma_px(double noise_px,
                               double residual,
                               double blur_px,
                               double white) {
  MAREY_ASSERT(noise_px >= 0.0 && residual >= 0.0 && blur_px > 0.0 && white >= 0.0);
  // Errors of neighbouring pixels are correlated, mainly by compression: the effective
  // noise is larger than with independent pixels, and some of it moves a whole edge.
  constexpr double kNoise = 1.4;
  constexpr double kEdge = 0.9;
  // A pixel is a box; if it is the larger part of the blur, a Gaussian is not the correct
  // shape. If white is clipped, only the lower part of each edge is visible, and the
  // shape matters more. Measured with drawn tags; upright ones are the worst case.
  constexpr double kShapePx = 0.05;
  constexpr double kClippedPx = 0.055;
  const double shape_px = kShapePx * std::min(1.0, 1.0 / (12.0 * blur_px * blur_px));
  const double clipped_px = white > 1.0 ? kClippedPx * white : 0.0;
  // If all edges are between two pixels, their position is unknown within one pixel.
  constexpr double kMaxNoisePx = 0.3;
  return std::hypot(kNoise * std::min(noise_px, kMaxNoisePx),
                    kEdge * residual * blur_px,
                    std::hypot(shape_px, clipped_px));
}

}  // namespace marey::capture
