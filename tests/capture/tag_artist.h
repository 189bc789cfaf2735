// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "capture/tags/align_pattern.h"
#include "capture/video/frame_source.h"
#include "core/detection.h"
#include "core/tag_pattern.h"

namespace marey::tests {

/// A tag to draw: its black square's corners in TagDetection's order, pixel centres at
/// integers. [px]
struct DrawnTag {
  std::string family = "tag36h11";
  int id = 0;
  std::array<glm::dvec2, 4> corners_px{};
};

/// Returns an upright square of `side_px` around `centre_px`, rotated by `turn_rad`
/// clockwise as seen in the image.
[[nodiscard]] std::array<glm::dvec2, 4> square(const glm::dvec2& centre_px,
                                               double side_px,
                                               double turn_rad = 0.0);

/// Returns a light grey 8-bit image with the tags: each pixel is the mean of the light on
/// it, coded with sRGB's curve, as in cameras.
[[nodiscard]] cv::Mat draw_tags(int width_px,
                                int height_px,
                                const std::vector<DrawnTag>& tags);

/// Conversion of light to grey in a camera.
struct Exposure {
  double gain = 1.0;  ///< Factor of the light; values above 1 are clipped. Paper is 0.72.
  double tone = 1.0;  ///< Exponent on top of sRGB's curve: below 1 lifts the shadows.
};

/// Blurs the light as a lens does, exposes it and adds noise [grey levels]. Equal seeds
/// give equal noise.
[[nodiscard]] cv::Mat disturbed(const cv::Mat& image,
                                double blur_sigma_px,
                                double noise_sigma,
                                unsigned seed,
                                const Exposure& exposure = {});

/// Returns the cells of a tag.
[[nodiscard]] TagPattern pattern_of(const DrawnTag& tag);

/// Returns the image for TagDetector; the image must outlive the view.
[[nodiscard]] capture::GrayFrame frame_of(const cv::Mat& gray);

/// Returns the largest distance of a found corner from its true one. [px]
[[nodiscard]] double worst_corner_px(const TagDetection& found, const DrawnTag& truth);

}  // namespace marey::tests
