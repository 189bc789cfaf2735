// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/boards/checker_corner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "core/base/assert.h"

namespace marey::capture {
namespace {

// Range of pixels along the edges: in squares, and in px, as lens distortion bends edges.
constexpr double kReach = 0.42;
constexpr double kMaxReachPx = 12.0;
// A pixel nearer than this to a marker contains some of its black.
constexpr double kMarkerBlurPx = 1.2;
constexpr std::size_t kMinPixels = 30;
// Minimum difference of white and black, in grey levels, and minimum share of the
// variance that the two edges explain.
constexpr double kMinContrast = 14.0;
constexpr double kMinExplained = 0.9;
constexpr double kMinBlurPx = 0.4;
constexpr double kMaxBlurPx = 4.0;

// Errors outside the fit's model: sharpening, compression, an uneven print. With four
// webcams at 1280x720 (caliscope's), each calibrated alone, 2700 corners of a ChArUco
// board have residuals of 0.03 to 0.06 px per coordinate at a fitted sigma of 0.02 to
// 0.03 px, and of 0.09 px at a blur of 1.3 px. (Residuals of cv::cornerSubPix() with its
// best window are 0.2 to 0.3 px.)
constexpr double kModelSigmaPx = 0.04;
constexpr double kSharpPx = 0.6;

constexpr int kUnknowns = 8;  // Corner x, y; angle and blur of each edge; middle, half.
using Step = cv::Vec<double, kUnknowns>;
using Normal = cv::Matx<double, kUnknowns, kUnknowns>;

struct Pixel {
  glm::dvec2 at_px{0.0};  ///< Relative to the guess.
  double grey = 0.0;
};

/// An edge through the corner; `normal` points away from the board's origin.
struct Edge {
  glm::dvec2 normal{0.0};
  double blur_px = 0.7;
};

struct Model {
  glm::dvec2 corner_px{0.0};  ///< Relative to the guess.
  Edge across_x;              ///< Edge at which x changes.
  Edge across_y;
  double middle = 0.0;  ///< Grey between black and white.
  double half = 0.0;    ///< Grey of the square at the origin, minus that.
};

struct Fit {
  Normal normal_matrix;
  Step gradient;
  double squares = 0.0;
};

/// Returns the normal of `along`, on the side of `towards`.
glm::dvec2 normal_to(const glm::dvec2& along, const glm::dvec2& towards) {
  const glm::dvec2 unit = glm::normalize(glm::dvec2(-along.y, along.x));
  return glm::dot(unit, towards) < 0.0 ? -unit : unit;
}

/// Contribution of an edge to the grey of a pixel, -1 to 1, and its derivative.
struct Slope {
  double value = 0.0;
  double by_distance = 0.0;
  double by_blur = 0.0;
};

Slope slope_at(double distance_px, double blur_px) {
  const double z = distance_px / blur_px;
  const double density = std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * z * z);
  return {std::erf(z / std::numbers::sqrt2),
          density / blur_px,
          -density * distance_px / blur_px / blur_px};
}

Fit linearise(const std::vector<Pixel>& pixels, const Model& model) {
  Fit fit;
  const glm::dvec2 nx = model.across_x.normal;
  const glm::dvec2 ny = model.across_y.normal;
  for (const Pixel& pixel : pixels) {
    const glm::dvec2 d = pixel.at_px - model.corner_px;
    const Slope x = slope_at(glm::dot(nx, d), model.across_x.blur_px);
    const Slope y = slope_at(glm::dot(ny, d), model.across_y.blur_px);
    const double by_x = model.half * x.by_distance * y.value;
    const double by_y = model.half * x.value * y.by_distance;
    const Step row(-by_x * nx.x - by_y * ny.x,
                   -by_x * nx.y - by_y * ny.y,
                   by_x * (nx.x * d.y - nx.y * d.x),
                   by_y * (ny.x * d.y - ny.y * d.x),
                   model.half * x.by_blur * y.value,
                   model.half * x.value * y.by_blur,
                   1.0,
                   x.value * y.value);
    const double residual = pixel.grey - model.middle - model.half * x.value * y.value;
    fit.squares += residual * residual;
    fit.gradient += residual * row;
    for (int i = 0; i < kUnknowns; ++i) {
      for (int j = i; j < kUnknowns; ++j) fit.normal_matrix(i, j) += row[i] * row[j];
    }
  }
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j < i; ++j) fit.normal_matrix(i, j) = fit.normal_matrix(j, i);
  }
  return fit;
}

void turn(Edge& edge, double angle_rad, double more_blur_px) {
  const glm::dvec2 n = edge.normal;
  edge.normal = glm::normalize(n + angle_rad * glm::dvec2(-n.y, n.x));
  edge.blur_px = std::clamp(edge.blur_px + more_blur_px, kMinBlurPx, kMaxBlurPx);
}

Model moved(Model model, const Step& step) {
  model.corner_px += glm::dvec2(step[0], step[1]);
  turn(model.across_x, step[2], step[4]);
  turn(model.across_y, step[3], step[5]);
  model.middle += step[6];
  model.half += step[7];
  return model;
}

/// Returns the pixels that show only the two edges.
std::vector<Pixel> pixels_around(const GrayFrame& frame, const CheckerGuess& guess) {
  std::vector<Pixel> pixels;
  const glm::dvec2& right = guess.along_x_px;
  const glm::dvec2& up = guess.along_y_px;
  const double area = right.x * up.y - right.y * up.x;
  const double width = std::abs(area) / glm::length(up);
  const double height = std::abs(area) / glm::length(right);
  if (!(std::min(width, height) > 4.0)) return pixels;
  const auto reach = static_cast<int>(std::ceil(
      std::min(kMaxReachPx, kReach * std::max(glm::length(right), glm::length(up)))));
  const auto x0 = static_cast<int>(std::lround(guess.pixel_px.x));
  const auto y0 = static_cast<int>(std::lround(guess.pixel_px.y));
  // A corner at the image's edge has too few pixels around it.
  if (x0 - 2 < 0 || y0 - 2 < 0 || x0 + 2 >= frame.width_px || y0 + 2 >= frame.height_px) {
    return pixels;
  }
  for (int y = std::max(0, y0 - reach); y <= std::min(frame.height_px - 1, y0 + reach);
       ++y) {
    const std::uint8_t* row =
        frame.pixels + static_cast<std::ptrdiff_t>(y) * frame.stride;
    for (int x = std::max(0, x0 - reach); x <= std::min(frame.width_px - 1, x0 + reach);
         ++x) {
      const glm::dvec2 d = glm::dvec2(x, y) - guess.pixel_px;
      if (glm::dot(d, d) > kMaxReachPx * kMaxReachPx) continue;
      const double bx = (d.x * up.y - d.y * up.x) / area;
      const double by = (right.x * d.y - right.y * d.x) / area;
      const double ax = std::abs(bx);
      const double ay = std::abs(by);
      if (std::max(ax, ay) > kReach) continue;
      const bool in_white = (bx * by > 0.0) != guess.black_at_origin;
      const bool by_marker = ax > guess.clear - kMarkerBlurPx / width &&
                             ay > guess.clear - kMarkerBlurPx / height;
      if (in_white && by_marker) continue;
      pixels.push_back({d, static_cast<double>(row[x])});
    }
  }
  return pixels;
}

/// Estimates black and white from the squares of the guess.
Model first_model(const std::vector<Pixel>& pixels, const CheckerGuess& guess) {
  Model model;
  model.across_x.normal = normal_to(guess.along_y_px, guess.along_x_px);
  model.across_y.normal = normal_to(guess.along_x_px, guess.along_y_px);
  double same = 0.0;  // Towards the origin and opposite.
  double other = 0.0;
  std::size_t count = 0;
  for (const Pixel& pixel : pixels) {
    const bool is_same = glm::dot(model.across_x.normal, pixel.at_px) *
                             glm::dot(model.across_y.normal, pixel.at_px) >
                         0.0;
    (is_same ? same : other) += pixel.grey;
    count += is_same ? 1 : 0;
  }
  same /= static_cast<double>(std::max<std::size_t>(count, 1));
  other /= static_cast<double>(std::max<std::size_t>(pixels.size() - count, 1));
  model.middle = 0.5 * (same + other);
  model.half = 0.5 * (same - other);
  return model;
}

double variance_sum(const std::vector<Pixel>& pixels) {
  double sum = 0.0;
  double squares = 0.0;
  for (const Pixel& pixel : pixels) {
    sum += pixel.grey;
    squares += pixel.grey * pixel.grey;
  }
  return squares - sum * sum / static_cast<double>(pixels.size());
}

}  // namespace

std::optional<CheckerCorner> find_checker_corner(const GrayFrame& frame,
                                                 const CheckerGuess& guess) {
  MAREY_ASSERT(frame.pixels != nullptr && frame.stride >= frame.width_px);
  const std::vector<Pixel> pixels = pixels_around(frame, guess);
  if (pixels.size() < kMinPixels) return std::nullopt;
  Model model = first_model(pixels, guess);
  const double sign = guess.black_at_origin ? -1.0 : 1.0;
  if (!(sign * model.half * 4.0 > kMinContrast)) return std::nullopt;

  constexpr int kMaxSteps = 20;
  constexpr double kSmallStepPx = 1e-3;
  Fit fit = linearise(pixels, model);
  double damping = 1e-3;
  for (int i = 0; i < kMaxSteps; ++i) {
    Normal damped = fit.normal_matrix;
    for (int k = 0; k < kUnknowns; ++k) damped(k, k) *= 1.0 + damping;
    Step step;
    if (!cv::solve(damped, fit.gradient, step, cv::DECOMP_CHOLESKY)) return std::nullopt;
    const Model next = moved(model, step);
    const Fit better = linearise(pixels, next);
    if (!(better.squares < fit.squares)) {
      damping *= 10.0;
      if (damping > 1e6) break;
      continue;
    }
    model = next;
    fit = better;
    damping = std::max(0.1 * damping, 1e-9);
    if (std::hypot(step[0], step[1]) < kSmallStepPx) break;
  }

  const double side_px =
      std::min(glm::length(guess.along_x_px), glm::length(guess.along_y_px));
  const bool has_diverged = glm::length(model.corner_px) > std::max(3.0, 0.1 * side_px);
  const bool is_dull = !(sign * model.half * 2.0 > kMinContrast);
  const bool is_other = fit.squares > (1.0 - kMinExplained) * variance_sum(pixels);
  if (has_diverged || is_dull || is_other) return std::nullopt;
  const double freedom = static_cast<double>(pixels.size()) - kUnknowns;
  bool ok = false;
  const Normal covariance = fit.normal_matrix.inv(cv::DECOMP_CHOLESKY, &ok);
  if (!ok) return std::nullopt;
  const double of_fit =
      std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)) * fit.squares / freedom);
  CheckerCorner corner;
  corner.pixel_px = guess.pixel_px + model.corner_px;
  corner.blur_px = std::max(model.across_x.blur_px, model.across_y.blur_px);
  corner.sigma_px =
      std::hypot(of_fit, kModelSigmaPx * std::max(1.0, corner.blur_px / kSharpPx));
  return corner;
}

}  // namespace marey::capture
