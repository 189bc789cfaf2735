// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/tag_artist.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/tags/tag_pattern.h"

namespace marey::tests {
namespace {

/// The printed tag, one pixel a cell, and the number of cells between the edge of the
/// paper and the square whose corners are detected.
struct Bitmap {
  cv::Mat cells;
  int margin_cells = 0;
};

Bitmap bitmap_of(const DrawnTag& tag) {
  const TagPattern pattern = pattern_of(tag);
  Bitmap bitmap{cv::Mat(pattern.cells, pattern.cells, CV_8UC1), pattern.margin_cells};
  std::transform(pattern.white.begin(),
                 pattern.white.end(),
                 bitmap.cells.begin<std::uint8_t>(),
                 [](std::uint8_t white) { return white != 0 ? 255 : 0; });
  return bitmap;
}

/// Convert light, 0 to 1, to 8-bit grey, and back. IEC 61966-2-1.
double gray_of_light(double light) {
  return 255.0 * (light <= 0.0031308 ? 12.92 * light
                                     : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
}
double light_of_gray(double gray) {
  const double x = gray / 255.0;
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

template <class Function>
cv::Mat mapped(const cv::Mat& image, const Function& function) {
  cv::Mat out;
  image.convertTo(out, CV_32F);
  out.forEach<float>([&](float& value, const int*) {
    value = static_cast<float>(function(static_cast<double>(value)));
  });
  return out;
}

cv::Mat as_gray(const cv::Mat& light) {
  cv::Mat gray;
  mapped(light, gray_of_light).convertTo(gray, CV_8U);
  return gray;
}

/// Resolution of the drawing relative to the image, before averaging.
constexpr int kFiner = 8;

cv::Point2f finer(double u, double v) {
  return {static_cast<float>((u + 0.5) * kFiner - 0.5),
          static_cast<float>((v + 0.5) * kFiner - 0.5)};
}

void draw_tag(const DrawnTag& tag, cv::Mat& fine_image) {
  const Bitmap bitmap = bitmap_of(tag);
  const double square_cells = bitmap.cells.cols - 2.0 * bitmap.margin_cells;
  const double fine_cell_pixels = kFiner *
                                  glm::distance(tag.corners_px[0], tag.corners_px[2]) /
                                  (std::numbers::sqrt2 * square_cells);
  // At least as fine as the drawing, or interpolation would blur the edges of large tags.
  // A power of two: cv::resize rounds others to a neighbouring pixel.
  int cell_pixels = 32;
  while (cell_pixels < fine_cell_pixels) cell_pixels *= 2;
  cv::Mat paper;
  cv::resize(bitmap.cells, paper, {}, cell_pixels, cell_pixels, cv::INTER_NEAREST);
  const auto low = static_cast<float>(bitmap.margin_cells * cell_pixels) - 0.5F;
  const auto high =
      static_cast<float>((bitmap.cells.cols - bitmap.margin_cells) * cell_pixels) - 0.5F;
  const std::array<cv::Point2f, 4> from{
      {{low, high}, {high, high}, {high, low}, {low, low}}};
  std::array<cv::Point2f, 4> to;
  for (std::size_t i = 0; i < 4; ++i) {
    to[i] = finer(tag.corners_px[i].x, tag.corners_px[i].y);
  }
  const cv::Mat fine_from_paper = cv::getPerspectiveTransform(from.data(), to.data());
  cv::Mat drawn;
  cv::Mat covered;
  cv::warpPerspective(paper, drawn, fine_from_paper, fine_image.size(), cv::INTER_LINEAR);
  cv::warpPerspective(cv::Mat(paper.size(), CV_8UC1, cv::Scalar(255)),
                      covered,
                      fine_from_paper,
                      fine_image.size(),
                      cv::INTER_NEAREST);
  // The light of black ink and of white paper.
  drawn.convertTo(drawn, CV_32F, 0.70 / 255.0, 0.02);
  drawn.copyTo(fine_image, covered);
}

}  // namespace

std::array<glm::dvec2, 4> square(const glm::dvec2& centre_px,
                                 double side_px,
                                 double turn_rad) {
  const double h = 0.5 * side_px;
  const glm::dvec2 x{h * std::cos(turn_rad), h * std::sin(turn_rad)};
  const glm::dvec2 y{-x.y, x.x};
  return {centre_px - x + y, centre_px + x + y, centre_px + x - y, centre_px - x - y};
}

cv::Mat draw_tags(int width_px, int height_px, const std::vector<DrawnTag>& tags) {
  cv::Mat fine(height_px * kFiner, width_px * kFiner, CV_32F, cv::Scalar(0.35));
  for (const DrawnTag& tag : tags) draw_tag(tag, fine);
  cv::Mat image;
  cv::resize(fine, image, {width_px, height_px}, 0, 0, cv::INTER_AREA);
  return as_gray(image);
}

cv::Mat disturbed(const cv::Mat& image,
                  double blur_sigma_px,
                  double noise_sigma,
                  unsigned seed,
                  const Exposure& exposure) {
  cv::Mat blurred = mapped(image, light_of_gray);
  if (blur_sigma_px > 0.0) cv::GaussianBlur(blurred, blurred, {0, 0}, blur_sigma_px);
  blurred = mapped(blurred, [&exposure](double light) {
    const double gray = gray_of_light(std::min(1.0, exposure.gain * light));
    return 255.0 * std::pow(gray / 255.0, exposure.tone);
  });
  cv::Mat noise(image.size(), CV_32F);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0.0, noise_sigma);
  cv::Mat out;
  cv::Mat(blurred + noise).convertTo(out, CV_8U);
  return out;
}

TagPattern pattern_of(const DrawnTag& tag) {
  const auto patterns =
      capture::tag_patterns(tag.family, std::array{static_cast<TagId>(tag.id)});
  if (!patterns) throw std::invalid_argument(patterns.error().message());
  return patterns->front();
}

capture::GrayFrame frame_of(const cv::Mat& gray) {
  return {gray.data, gray.cols, gray.rows, static_cast<int>(gray.step[0]), 0};
}

double worst_corner_px(const TagDetection& found, const DrawnTag& truth) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    worst = std::max(worst, glm::distance(found.corners_px[i], truth.corners_px[i]));
  }
  return worst;
}

}  // namespace marey::tests
