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

/// A tag to draw, and where: its black square's corners in TagDetection's order, pixel
/// centres at integers. [px]
struct DrawnTag {
  std::string family = "tag36h11";
  int id = 0;
  std::array<glm::dvec2, 4> corners_px{};
};

/// An upright square of `side_px` about `centre_px`, turned by `turn_rad` clockwise as
/// seen in the image.
[[nodiscard]] std::array<glm::dvec2, 4> square(const glm::dvec2& centre_px,
                                               double side_px,
                                               double turn_rad = 0.0);

/// A light grey 8-bit image with the tags in it: each pixel the mean of the light that
/// falls on it, coded by sRGB's curve, as cameras do.
[[nodiscard]] cv::Mat draw_tags(int width_px,
                                int height_px,
                                const std::vector<DrawnTag>& tags);

/// How a camera turns light into grey.
struct Exposure {
  double gain = 1.0;  ///< Of the light; what then exceeds 1 is clipped. Paper is 0.72.
  double tone = 1.0;  ///< Exponent on top of sRGB's curve: below 1 lifts the shadows.
};

/// Blurs the light as a lens does, exposes it and adds noise [grey levels]. The same seed
/// gives the same noise.
[[nodiscard]] cv::Mat disturbed(const cv::Mat& image,
                                double blur_sigma_px,
                                double noise_sigma,
                                unsigned seed,
                                const Exposure& exposure = {});

/// The cells of a tag.
[[nodiscard]] TagPattern pattern_of(const DrawnTag& tag);

/// The image as TagDetector wants it; it must outlive the view.
[[nodiscard]] capture::GrayFrame frame_of(const cv::Mat& gray);

/// The longest way from a found corner to its true one. [px]
[[nodiscard]] double worst_corner_px(const TagDetection& found, const DrawnTag& truth);

}  // namespace marey::tests
