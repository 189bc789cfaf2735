// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "capture/frame_source.h"

// Private to capture/.
namespace marey::capture {

/// Where four squares of a board should meet.
struct CheckerGuess {
  glm::dvec2 pixel_px{0.0};
  /// From the corner one square along the board's x, and along its y. [px]
  glm::dvec2 along_x_px{0.0};
  glm::dvec2 along_y_px{0.0};
  /// Of the four squares around it that towards the board's origin is black.
  bool black_at_origin = false;
  /// White squares show nothing but white this near to their edges. In squares; 0.5 when
  /// they are empty.
  double clear = 0.5;
};

struct CheckerCorner {
  glm::dvec2 pixel_px{0.0};  ///< Pixel centres at integers.
  double sigma_px = 0.3;     ///< Standard deviation of one coordinate.
  double blur_px = 0.0;      ///< Standard deviation of the blur, of its wider edge.
};

/// Moves a corner to where two blurred edges that cross agree best with the image.
///
/// The unknowns are the corner, the direction and blur of either edge, and the grey of
/// black and white; Levenberg-Marquardt on the difference of grey values, over the pixels
/// that show nothing but these edges. What light spreads into black squares moves all
/// four squares alike, so that grey values will do. sigma_px is that of the fit and what
/// measurements say a fit does not know of (checker_corner.cpp).
/// nullopt when the image is too small there, or shows something else: a finger, another
/// corner, too little contrast. Precondition: the guess is within 3 px, or a tenth of a
/// square, of the truth. 0.1 ms; more for squares of 30 px and above than below.
[[nodiscard]] std::optional<CheckerCorner> find_checker_corner(const GrayFrame& frame,
                                                               const CheckerGuess& guess);

}  // namespace marey::capture
