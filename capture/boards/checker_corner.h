// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "capture/video/frame_source.h"

// Private to capture.
namespace marey::capture {

/// Expected position of a corner where four squares of a board meet.
struct CheckerGuess {
  glm::dvec2 pixel_px{0.0};
  /// To the corner one square along the board's x, and along its y. [px]
  glm::dvec2 along_x_px{0.0};
  glm::dvec2 along_y_px{0.0};
  /// True if, of the four adjacent squares, the one towards the board's origin is black.
  bool black_at_origin = false;
  /// Width of the empty margin along the edges of white squares. In squares; 0.5 if white
  /// squares are empty.
  double clear = 0.5;
};

struct CheckerCorner {
  glm::dvec2 pixel_px{0.0};  ///< Pixel centres at integers.
  double sigma_px = 0.3;     ///< Standard deviation of one coordinate.
  double blur_px = 0.0;      ///< Standard deviation of the blur, of its wider edge.
};

/// Fits a corner to the image as the crossing of two blurred edges.
///
/// The unknowns are the corner, the direction and blur of either edge, and the grey of
/// black and white. Levenberg-Marquardt on the difference of grey values, over the pixels
/// that show only these edges. Light that spreads into black squares moves all four
/// squares equally, so grey values need no conversion to light. sigma_px combines the
/// sigma of the fit and a measured contribution that the fit does not include
/// (checker_corner.cpp).
/// Returns nullopt if the image is too small there, or shows something else: a finger,
/// another corner, too little contrast. Precondition: the guess is within 3 px, or a
/// tenth of a square, of the truth. Cost: 0.1 ms; more for squares of 30 px and above
/// than below.
[[nodiscard]] std::optional<CheckerCorner> find_checker_corner(const GrayFrame& frame,
                                                               const CheckerGuess& guess);

}  // namespace marey::capture
