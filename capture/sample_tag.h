// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "capture/frame_source.h"
#include "core/tag_pattern.h"

// Private to capture/.
namespace marey::capture {

/// A pixel of a tag, relative to the tag's middle, and its light.
struct AlignPixel {
  double x = 0.0;
  double y = 0.0;
  double light = 0.0;  ///< 0 to 1, by sRGB's curve.
  bool black = false;  ///< As dark as a pixel can tell: perhaps darker.
  bool white = false;  ///< As bright as a pixel can tell: perhaps brighter.
};

/// Replaces `pixels` with the pixels that tell where a tag is: its square, whose middle
/// is at `middle_px`, and 0.6 of a cell around it, within the image. All of a small tag;
/// of one that is wider than some 70 px about 5000, most of them in rows across the edges
/// of its cells, at places along them that follow no grid, so that no edge of an upright
/// tag falls between them. None when the horizon crosses the tag.
void sample_tag(const GrayFrame& frame,
                const TagPattern& pattern,
                const cv::Matx33d& image_from_cell,
                const glm::dvec2& middle_px,
                std::vector<AlignPixel>& pixels);

}  // namespace marey::capture
