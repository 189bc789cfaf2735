// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "capture/blurred_pattern.h"
#include "capture/frame_source.h"

// Private to capture/.
namespace marey::capture {

/// Where a pattern lies in an image, and how it is seen.
struct Alignment {
  /// In TagDetection's order and convention. [px]
  std::array<glm::dvec2, 4> corners_px{};
  double blur_px = 0.0;   ///< Standard deviation of the blur, the pixel's own included.
  double residual = 0.0;  ///< Root mean square, as a share of white minus black.
};

/// A pixel of a tag, relative to the tag's middle, and its light.
struct AlignPixel {
  double x = 0.0;
  double y = 0.0;
  double light = 0.0;
};

/// Memory that align_pattern() works in; keep it from call to call.
using AlignScratch = std::vector<AlignPixel>;

/// Moves the corners of a tag to where its whole pattern, blurred and lit, agrees best
/// with the image. Every edge of every cell counts, and neighbouring cells, which draw a
/// search along the outer edges aside, are part of the model.
///
/// The unknowns are a homography, the blur's width, and for black and white each a
/// brightness that varies linearly over the tag; Levenberg-Marquardt with Huber's weights
/// on the squared difference of light. Blur happens in the lens, so grey values are
/// turned into light first, by sRGB's curve: without, black squares come out too small.
/// Preconditions: `corners_px` within about half a cell of the truth; a pattern of at
/// least 4 cells. nullopt when the fit does not converge near there or the image is
/// something else; then the caller's corners are as good as it gets. About 1 ms for a
/// tag of 22 px; the cost grows with the area up to some 70 px and stays level above.
/// Allocates only when `scratch` has to grow. Source: B. D. Lucas, T. Kanade, "An
/// iterative image registration technique", 1981.
[[nodiscard]] std::optional<Alignment> align_pattern(
    const GrayFrame& frame,
    const TagPattern& pattern,
    const std::array<glm::dvec2, 4>& corners_px,
    AlignScratch& scratch);

}  // namespace marey::capture
