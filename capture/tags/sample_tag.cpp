// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/sample_tag.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>

#include "core/detection.h"

namespace marey::capture {
namespace {

/// Width of the margin around the square in which pixels count. [cells]
constexpr double kRingCells = 0.6;

/// Light of each grey value, 0 to 1. IEC 61966-2-1.
const std::array<double, 256>& light_of_gray() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double x = static_cast<double>(i) / 255.0;
      light[i] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    }
    return light;
  }();
  return table;
}

/// Numbers from 0 to 1 that fill the range evenly without a period: multiples of an
/// irrational number.
class Spread {
 public:
  explicit Spread(double step) : step_(step) {}
  double next() {
    at_ += step_;
    if (at_ >= 1.0) at_ -= 1.0;
    return at_;
  }

 private:
  double step_;
  double at_ = 0.5;
};

class Sampler {
 public:
  Sampler(const GrayFrame& frame,
          const TagPattern& pattern,
          const cv::Matx33d& image_from_cell,
          const glm::dvec2& middle_px,
          std::vector<AlignPixel>& pixels)
      : frame_(frame),
        pattern_(pattern),
        image_from_cell_(image_from_cell),
        cell_from_image_(image_from_cell.inv()),
        middle_px_(middle_px),
        reach_(0.5 * (pattern.cells - 2 * pattern.margin_cells) + kRingCells),
        pixels_(pixels) {}

  void run();

 private:
  /// Takes one pixel of each block of `step` by `step`.
  void take_blocks(int step);
  /// Takes pixels across the edges between cells of two colours, `per_edge` rows of them
  /// each.
  void take_edges(int per_edge);
  void take_across(double u, double v, bool upright);
  void take(int x, int y);

  [[nodiscard]] int edges() const;
  [[nodiscard]] bool white(int column, int row) const {
    return pattern_.white[static_cast<std::size_t>(row * pattern_.cells + column)] != 0;
  }
  /// Calls `visit` for each line between two cells of a row, with their number and the
  /// row's.
  template <class Visit>
  void visit_edges(const Visit& visit) const;

  const GrayFrame& frame_;
  const TagPattern& pattern_;
  const cv::Matx33d image_from_cell_;
  const cv::Matx33d cell_from_image_;
  const glm::dvec2 middle_px_;
  const double reach_;  ///< From the middle. [cells]
  std::vector<AlignPixel>& pixels_;
  int x0_ = 0;
  int y0_ = 0;
  int x1_ = -1;
  int y1_ = -1;
};

void Sampler::run() {
  glm::dvec2 low(std::numeric_limits<double>::max());
  glm::dvec2 high(-low);
  for (const auto& corner : kCornerSides) {
    const cv::Vec3d p =
        image_from_cell_ * cv::Vec3d(reach_ * corner[0], reach_ * corner[1], 1.0);
    if (!(p[2] > 0.0)) return;  // Slanted so that the horizon crosses the margin.
    const glm::dvec2 pixel = middle_px_ + glm::dvec2(p[0], p[1]) / p[2];
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  x0_ = std::max(0, static_cast<int>(std::ceil(low.x)));
  y0_ = std::max(0, static_cast<int>(std::ceil(low.y)));
  x1_ = std::min(frame_.width_px - 1, static_cast<int>(std::floor(high.x)));
  y1_ = std::min(frame_.height_px - 1, static_cast<int>(std::floor(high.y)));
  // A large tag has more pixels than needed, most of them far from any edge.
  constexpr int kMaxPerSide = 72;
  constexpr int kBlocksPerSide = 24;
  constexpr int kRows = 250;
  const double side_px = std::max(high.x - low.x, high.y - low.y);
  if (!(side_px >= kMaxPerSide)) {
    take_blocks(1);
    return;
  }
  take_blocks(1 + static_cast<int>(side_px) / kBlocksPerSide);
  take_edges(std::max(2, kRows / std::max(1, edges())));
}

void Sampler::take_blocks(int step) {
  Spread right(0.7548776662466927);  // Roberts' sequence of two dimensions.
  Spread down(0.5698402909980532);
  for (int y = y0_; y <= y1_; y += step) {
    for (int x = x0_; x <= x1_; x += step) {
      take(x + static_cast<int>(right.next() * step),
           y + static_cast<int>(down.next() * step));
    }
  }
}

void Sampler::take(int x, int y) {
  if (x < x0_ || x > x1_ || y < y0_ || y > y1_) return;
  const glm::dvec2 p = glm::dvec2(x, y) - middle_px_;
  const cv::Vec3d cell = cell_from_image_ * cv::Vec3d(p.x, p.y, 1.0);
  if (std::max(std::abs(cell[0]), std::abs(cell[1])) > reach_ * std::abs(cell[2])) return;
  const std::uint8_t gray =
      frame_.pixels[static_cast<std::ptrdiff_t>(y) * frame_.stride + x];
  // In video, the ends of the range are not always 0 and 255.
  constexpr std::uint8_t kBlack = 3;
  constexpr std::uint8_t kWhite = 250;
  pixels_.push_back({p.x, p.y, light_of_gray()[gray], gray <= kBlack, gray >= kWhite});
}

template <class Visit>
void Sampler::visit_edges(const Visit& visit) const {
  for (int along = 0; along < pattern_.cells; ++along) {
    for (int across = 0; across + 1 < pattern_.cells; ++across) {
      if (white(across, along) != white(across + 1, along)) visit(across, along, true);
      if (white(along, across) != white(along, across + 1)) visit(across, along, false);
    }
  }
}

int Sampler::edges() const {
  int count = 0;
  visit_edges([&count](int, int, bool) { ++count; });
  return count;
}

void Sampler::take_edges(int per_edge) {
  Spread spread(0.6180339887498949);
  const double middle = 0.5 * pattern_.cells;
  visit_edges([&](int across, int along, bool upright) {
    for (int i = 0; i < per_edge; ++i) {
      const double line = across + 1 - middle;
      const double place = along + (i + spread.next()) / per_edge - middle;
      take_across(upright ? line : place, upright ? place : line, upright);
    }
  });
}

void Sampler::take_across(double u, double v, bool upright) {
  const cv::Matx33d& h = image_from_cell_;
  const cv::Vec3d p = h * cv::Vec3d(u, v, 1.0);
  if (!(p[2] > 0.0)) return;
  const double x = p[0] / p[2];
  const double y = p[1] / p[2];
  // Along the edge; a row across it follows the image axis that crosses it at the steeper
  // angle.
  const int axis = upright ? 1 : 0;
  const double along_x = h(0, axis) - h(2, axis) * x;
  const double along_y = h(1, axis) - h(2, axis) * y;
  const bool sideways = std::abs(along_y) >= std::abs(along_x);
  // Small distances for sharp edges, large ones for blurred edges or an inaccurate start.
  constexpr std::array<int, 11> kApart{0, -1, 1, -2, 2, -3, 3, -5, 5, -8, 8};
  const double cell_px =
      std::sqrt(std::abs((h(0, 0) - h(2, 0) * x) * (h(1, 1) - h(2, 1) * y) -
                         (h(0, 1) - h(2, 1) * x) * (h(1, 0) - h(2, 0) * y))) /
      p[2];
  const auto column = static_cast<int>(std::lround(x + middle_px_.x));
  const auto row = static_cast<int>(std::lround(y + middle_px_.y));
  for (const int apart : kApart) {
    if (std::abs(apart) > std::max(3.0, 0.5 * cell_px)) break;
    take(column + (sideways ? apart : 0), row + (sideways ? 0 : apart));
  }
}

}  // namespace

void sample_tag(const GrayFrame& frame,
                const TagPattern& pattern,
                const cv::Matx33d& image_from_cell,
                const glm::dvec2& middle_px,
                std::vector<AlignPixel>& pixels) {
  pixels.clear();
  Sampler(frame, pattern, image_from_cell, middle_px, pixels).run();
}

}  // namespace marey::capture
