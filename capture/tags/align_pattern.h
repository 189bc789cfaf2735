// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "capture/tags/blurred_pattern.h"
#include "capture/tags/sample_tag.h"
#include "capture/video/frame_source.h"

// Private to capture.
namespace marey::capture {

/// Pose of a pattern in an image, and the quality of the fit.
struct Alignment {
  /// In TagDetection's order and convention. [px]
  std::array<glm::dvec2, 4> corners_px{};
  double sigma_px = 0.0;  ///< aligned_corner_sigma_px() of this fit.
  double blur_px = 0.0;   ///< Standard deviation of the blur, the pixel's own included.
  double residual = 0.0;  ///< Root mean square, as a share of white minus black.
};

/// Memory for align_pattern(); reuse it between calls.
using AlignScratch = std::vector<AlignPixel>;

/// Refines the corners of a tag by fitting its whole pattern, blurred and lit, to the
/// image. All edges of all cells contribute. Neighbouring cells, which bias a search
/// along the outer edges, are part of the model.
///
/// The unknowns are a homography, the width of the blur, a brightness of black and of
/// white that varies linearly over the tag, and the curvature of the tone curve.
/// Levenberg-Marquardt with Huber weights on the squared difference of light. Blur acts
/// on light in the lens, so grey values are first converted to light with sRGB's curve;
/// without the conversion, black squares appear too small. The curvature models the
/// difference between a camera's tone curve and sRGB's. The residual is zero if both the
/// pixel and the model are beyond white or beyond black: an overexposed tag is fitted to
/// its pixels that are not clipped.
/// Preconditions: `corners_px` within about half a cell of the truth; a pattern of at
/// least 4 cells; slack_px >= 0. Returns nullopt if the fit does not converge near the
/// start, a corner moves further than `slack_px` plus the bias of an edge search at this
/// blur, or the image shows something else; the caller's corners are then the best
/// estimate. Cost: about 1 ms for a tag of 22 px; grows with the area up to some 70 px
/// and is constant above. Allocates only if `scratch` has to grow. Source: B. D. Lucas,
/// T. Kanade, "An iterative image registration technique", 1981.
[[nodiscard]] std::optional<Alignment> align_pattern(
    const GrayFrame& frame,
    const TagPattern& pattern,
    const std::array<glm::dvec2, 4>& corners_px,
    double slack_px,
    AlignScratch& scratch);

/// Returns the standard deviation of one coordinate of an aligned corner. `noise_px` is
/// the propagated pixel noise, with independent pixels; `residual` and `blur_px` are as
/// in Alignment; `white` is the light of the tag's white, with 1 at the clipping level of
/// pixels. Preconditions: blur_px > 0, the others >= 0.
[[nodiscard]] double aligned_corner_sigma_px(double noise_px,
                                             double residual,
                                             double blur_px,
                                             double white);

}  // namespace marey::capture
