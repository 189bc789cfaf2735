// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "capture/video/frame_source.h"
#include "core/tag_pattern.h"

// Private to capture.
namespace marey::capture {

/// A pixel of a tag, relative to the tag's middle, and its light.
struct AlignPixel {
  double x = 0.0;
  double y = 0.0;
  double light = 0.0;  ///< 0 to 1, by sRGB's curve.
  bool black = false;  ///< At the lower clipping level: the light may be lower.
  bool white = false;  ///< At the upper clipping level: the light may be higher.
};

/// Replaces `pixels` with the pixels that constrain a tag's pose: its square, whose
/// middle is at `middle_px`, and a margin of 0.6 cells, within the image. Uses all pixels
/// of a small tag. For a tag wider than some 70 px, about 5000 pixels are sampled, most
/// of them in rows across the edges of its cells at irregular distances, so that every
/// edge of an upright tag is sampled. Returns none if the horizon crosses the tag.
void sample_tag(const GrayFrame& frame,
                const TagPattern& pattern,
                const cv::Matx33d& image_from_cell,
                const glm::dvec2& middle_px,
                std::vector<AlignPixel>& pixels);

}  // namespace marey::capture
