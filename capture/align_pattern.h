// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "capture/blurred_pattern.h"
#include "capture/frame_source.h"
#include "capture/sample_tag.h"

// Private to capture/.
namespace marey::capture {

/// Where a pattern lies in an image, and how it is seen.
struct Alignment {
  /// In TagDetection's order and convention. [px]
  std::array<glm::dvec2, 4> corners_px{};
  double sigma_px = 0.0;  ///< aligned_corner_sigma_px() of this fit.
  double blur_px = 0.0;   ///< Standard deviation of the blur, the pixel's own included.
  double residual = 0.0;  ///< Root mean square, as a share of white minus black.
};

/// Memory that align_pattern() works in; keep it from call to call.
using AlignScratch = std::vector<AlignPixel>;

/// Moves the corners of a tag to where its whole pattern, blurred and lit, agrees best
/// with the image. Every edge of every cell counts, and neighbouring cells, which draw a
/// search along the outer edges aside, are part of the model.
///
/// The unknowns are a homography, the blur's width, for black and white each a
/// brightness that varies linearly over the tag, and how far the tone curve is bent;
/// Levenberg-Marquardt with Huber's weights on the squared difference of light. Blur
/// happens in the lens, so grey values are turned into light first, by sRGB's curve:
/// without, black squares come out too small. A camera's own curve is not quite that one:
/// hence the bend. Where both the pixel and the model are beyond white or black they
/// agree, so that an overexposed tag is known by what is not clipped.
/// Preconditions: `corners_px` within about half a cell of the truth; a pattern of at
/// least 4 cells; slack_px >= 0. nullopt when the fit does not converge near there,
/// a corner moves further than `slack_px` and what this blur does to a search along
/// edges, or the image is something else; then the caller's corners are as good as it
/// gets. About 1 ms for a tag of 22 px; the cost grows with the area up to some 70 px and
/// stays level above. Allocates only when `scratch` has to grow. Source: B. D. Lucas,
/// T. Kanade, "An iterative image registration technique", 1981.
[[nodiscard]] std::optional<Alignment> align_pattern(
    const GrayFrame& frame,
    const TagPattern& pattern,
    const std::array<glm::dvec2, 4>& corners_px,
    double slack_px,
    AlignScratch& scratch);

/// Standard deviation of one coordinate of an aligned corner. `noise_px` is what the fit
/// makes of the pixels' noise, as if each erred on its own; `residual` and `blur_px` are
/// as in Alignment; `white` is the light of the tag's white, 1 being where pixels are
/// clipped. Preconditions: blur_px > 0, the others >= 0.
[[nodiscard]] double aligned_corner_sigma_px(double noise_px,
                                             double residual,
                                             double blur_px,
                                             double white);

}  // namespace marey::capture
