// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/align_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "capture/tags/blurred_pattern.h"
#include "capture/tags/cell_place.h"
#include "capture/tags/sample_tag.h"
#include "core/base/assert.h"
#include "core/detection.h"

namespace marey::capture {
namespace {

constexpr int kPlace = 8;          // Homography, its last element being 1.
constexpr int kBlur = kPlace;      // Logarithm of the blur.
constexpr int kBend = kBlur + 1;   // Curvature of the tone curve.
constexpr int kLight = kBend + 1;  // First of the six of the light.
constexpr int kUnknowns = kLight + 6;

/// Typical pixel noise and tone curvature, as shares of the contrast: together they
/// weight a prior for parameters that a tag with few edges does not determine.
constexpr double kTypicalNoise = 0.02;
constexpr double kTypicalBend = 0.25;
using Unknowns = cv::Vec<double, kUnknowns>;
using Normal = cv::Matx<double, kUnknowns, kUnknowns>;

/// std::hypot without its handling of extreme numbers, which do not occur in images.
double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

cv::Matx33d homography(const Unknowns& unknowns) {
  cv::Matx33d h;
  for (int i = 0; i < kPlace; ++i) h.val[i] = unknowns[i];
  h.val[kPlace] = 1.0;
  return h;
}

/// One step's linear system, and the cost at its state.
struct System {
  Normal normal = Normal::zeros();  ///< Its upper half, until closed().
  Unknowns right = Unknowns::all(0.0);
  double cost = 0.0;
  double squares = 0.0;
  int pixels = 0;  ///< Number of pixels with a weight.

  /// Adds a pixel of `slope`, whose unknowns before `First` are zero. Two columns at a
  /// time, as processors handle pairs: an element left of the diagonal does no harm.
  template <std::size_t First>
  void add(const std::array<double, kUnknowns>& slope, double weight, double error) {
    static_assert(First % 2 == 0 && kUnknowns % 2 == 0);
    for (std::size_t i = First; i < kUnknowns; ++i) {
      const double scaled = weight * slope[i];
      right.val[i] += scaled * error;
      double* row = normal.val + i * kUnknowns;
      for (std::size_t j = i - i % 2; j < kUnknowns; j += 2) {
        row[j] += scaled * slope[j];
        row[j + 1] += scaled * slope[j + 1];
      }
    }
  }

  /// Fills the lower half.
  void close() {
    for (int i = 0; i < kUnknowns; ++i) {
      for (int j = 0; j < i; ++j) normal(i, j) = normal(j, i);
    }
  }
};

class Fit {
 public:
  Fit(const GrayFrame& frame,
      const TagPattern& pattern,
      const std::array<glm::dvec2, 4>& corners_px,
      AlignScratch& scratch);

  /// Returns false if the fit does not converge.
  bool run();
  [[nodiscard]] Alignment answer() const;

 private:
  /// Returns the root mean square of the standard deviations of the corners' coordinates
  /// for a pixel noise of 1.
  [[nodiscard]] double spread(const Normal& normal) const;
  [[nodiscard]] bool guess_light();
  /// Linearises by all unknowns, or by those of the light alone with a quarter of the
  /// pixels.
  [[nodiscard]] System linearized(const Unknowns& at, bool light_alone = false) const;
  void add(const AlignPixel& pixel,
           const Place& place,
           const Blurred& model,
           const Unknowns& at,
           System& system) const;

  const TagPattern& pattern_;
  double half_cells_;  ///< Half of the square's side.
  glm::dvec2 middle_px_{0.0};
  Unknowns state_ = Unknowns::all(0.0);
  AlignScratch& pixels_;
  double residual_ = 0.0;
  double noise_px_ = 0.0;     ///< Effect of the pixels' noise on a corner.
  double bend_weight_ = 0.0;  ///< Prior weight of a straight tone curve.
};

/// Computes the homography from the corners of a square of half side `h` to `corners`.
/// Returns false if there is none.
bool through_corners(double h,
                     const std::array<glm::dvec2, 4>& corners,
                     Unknowns& unknowns) {
  cv::Matx<double, 8, 8> a = cv::Matx<double, 8, 8>::zeros();
  cv::Vec<double, 8> b;
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double u = h * kCornerSides[k][0];
    const double v = h * kCornerSides[k][1];
    for (int axis = 0; axis < 2; ++axis) {
      const double p = corners[k][axis];
      const int row = 2 * i + axis;
      a(row, 3 * axis) = u;
      a(row, 3 * axis + 1) = v;
      a(row, 3 * axis + 2) = 1.0;
      a(row, 6) = -p * u;
      a(row, 7) = -p * v;
      b[row] = p;
    }
  }
  bool solved = false;
  const auto inverse = a.inv(cv::DECOMP_LU, &solved);
  if (!solved) return false;
  const auto h8 = inverse * b;
  for (int i = 0; i < kPlace; ++i) unknowns[i] = h8[i];
  return true;
}

Fit::Fit(const GrayFrame& frame,
         const TagPattern& pattern,
         const std::array<glm::dvec2, 4>& corners_px,
         AlignScratch& scratch)
    : pattern_(pattern),
      half_cells_(0.5 * (pattern.cells - 2 * pattern.margin_cells)),
      pixels_(scratch) {
  pixels_.clear();
  for (const auto& corner : corners_px) middle_px_ += 0.25 * corner;
  std::array<glm::dvec2, 4> from_middle = corners_px;
  for (auto& corner : from_middle) corner -= middle_px_;
  if (!through_corners(half_cells_, from_middle, state_)) return;
  constexpr double kTypicalBlurPx = 0.55;  // A sharp lens and the width of a pixel.
  state_[kBlur] = std::log(kTypicalBlurPx);
  sample_tag(frame, pattern, homography(state_), middle_px_, pixels_);
}

void Fit::add(const AlignPixel& pixel,
              const Place& place,
              const Blurred& model,
              const Unknowns& at,
              System& system) const {
  const double across = place.u / half_cells_;
  const double down = place.v / half_cells_;
  const double* light = at.val + kLight;
  const double contrast = light[1] + light[4] * across + light[5] * down;
  // The tone curve: half white is brighter than half by a quarter of its bend.
  const double bulge = model.value * (1.0 - model.value);
  const double value = model.value + at[kBend] * bulge;
  const double shown = light[0] + light[2] * across + light[3] * down + contrast * value;
  const double error = pixel.light - shown;
  // A clipped pixel constrains the light only on one side.
  if ((pixel.white && error < 0.0) || (pixel.black && error > 0.0)) return;
  ++system.pixels;

  constexpr double kHuberLimit = 0.08;  // Share of the contrast: dirt, highlight.
  const double limit = kHuberLimit * std::abs(light[1]);
  const double size = std::abs(error);
  const double weight = limit <= 0.0 || size <= limit ? 1.0 : limit / size;
  system.cost += weight * error * error;
  system.squares += error * error;

  std::array<double, kUnknowns> slope{};
  slope[kLight] = 1.0;
  slope[kLight + 1] = value;
  slope[kLight + 2] = across;
  slope[kLight + 3] = down;
  slope[kLight + 4] = across * value;
  slope[kLight + 5] = down * value;
  slope[kBend] = contrast * bulge;
  if (model.flat) {
    system.add<kLight>(slope, weight, error);
    return;
  }
  // The pattern moves with its pose, so a fixed image point moves backwards in the
  // pattern.
  const double steepness = contrast * (1.0 + at[kBend] * (1.0 - 2.0 * model.value));
  const double by_x =
      -steepness * (model.by_u * place.u_by_x + model.by_v * place.v_by_x);
  const double by_y =
      -steepness * (model.by_u * place.u_by_y + model.by_v * place.v_by_y);
  const double turn = -(by_x * pixel.x + by_y * pixel.y);
  const double per_depth = 1.0 / place.depth;
  const double u = place.u * per_depth;
  const double v = place.v * per_depth;
  slope[0] = by_x * u;
  slope[1] = by_x * v;
  slope[2] = by_x * per_depth;
  slope[3] = by_y * u;
  slope[4] = by_y * v;
  slope[5] = by_y * per_depth;
  slope[6] = turn * u;
  slope[7] = turn * v;
  slope[kBlur] = steepness * model.by_log_sigma;
  system.add<0>(slope, weight, error);
}

System Fit::linearized(const Unknowns& at, bool light_alone) const {
  System system;
  const cv::Matx33d image_from_cell = homography(at);
  const cv::Matx33d cell_from_image = image_from_cell.inv();
  const double blur_px = std::exp(at[kBlur]);
  const double middle_cells = 0.5 * pattern_.cells;
  CellWeights u;
  CellWeights v;
  // A quarter is sufficient for an initial guess.
  const std::size_t step = light_alone ? 4 : 1;
  for (std::size_t i = 0; i < pixels_.size(); i += step) {
    const AlignPixel& pixel = pixels_[i];
    const Place place = place_of(image_from_cell, cell_from_image, pixel.x, pixel.y);
    // The blur is round in the image; of its ellipse in the cells, only the axes are
    // used.
    weigh_cells(place.u + middle_cells,
                blur_px * length(place.u_by_x, place.u_by_y),
                pattern_.cells,
                u);
    weigh_cells(place.v + middle_cells,
                blur_px * length(place.v_by_x, place.v_by_y),
                pattern_.cells,
                v);
    Blurred model = blurred(pattern_, u, v);
    model.flat |= light_alone;
    add(pixel, place, model, at, system);
  }
  system.normal(kBend, kBend) += bend_weight_;
  system.right[kBend] -= bend_weight_ * at[kBend];
  system.cost += bend_weight_ * at[kBend] * at[kBend];
  system.close();
  return system;
}

/// Solves for the light alone, which is a linear problem.
bool Fit::guess_light() {
  const System system = linearized(state_, true);
  cv::Matx<double, 2, 2> normal;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) normal(i, j) = system.normal(kLight + i, kLight + j);
  }
  bool solved = false;
  const auto inverse = normal.inv(cv::DECOMP_LU, &solved);
  if (!solved) return false;
  const auto light = inverse * cv::Vec2d(system.right[kLight], system.right[kLight + 1]);
  state_[kLight] = light[0];
  state_[kLight + 1] = light[1];
  constexpr double kMinContrast = 0.01;  // Below this, alignment is impossible.
  bend_weight_ = std::pow(kTypicalNoise / kTypicalBend * light[1], 2);
  const auto clipped = std::count_if(
      pixels_.begin(), pixels_.end(), [](const AlignPixel& p) { return p.white; });
  // Overexposed: white is beyond the range of pixels; the curvature must not absorb this.
  constexpr int kFew = 20;
  if (kFew * clipped > static_cast<std::ptrdiff_t>(pixels_.size())) {
    state_[kLight + 1] *= 1.4;
    bend_weight_ *= 100.0;
  }
  return light[1] > kMinContrast;
}

bool Fit::run() {
  if (pixels_.size() < 4 * static_cast<std::size_t>(kUnknowns) || !guess_light()) {
    return false;
  }
  constexpr int kMaxSteps = 12;
  constexpr double kMaxDamping = 1e3;
  // The remaining gain is far below the uncertainty; more iterations cost time.
  constexpr double kMinGainShare = 1e-2;
  System system = linearized(state_);
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps && damping < kMaxDamping; ++step) {
    Normal damped = system.normal;
    for (int i = 0; i < kUnknowns; ++i) damped(i, i) *= 1.0 + damping;
    bool solved = false;
    const Normal inverse = damped.inv(cv::DECOMP_CHOLESKY, &solved);
    if (!solved) return false;
    const Unknowns change = inverse * system.right;
    Unknowns next = state_ + change;
    next[kBend] = std::clamp(next[kBend], -0.8, 0.8);
    next[kBlur] = std::clamp(next[kBlur], std::log(0.25), std::log(4.0));
    // The last step follows the quadratic model without another evaluation, which would
    // cost a quarter of the whole.
    if (change.dot(system.right) < kMinGainShare * system.cost) {
      state_ = next;
      break;
    }
    const System there = linearized(next);
    if (!(there.cost < system.cost)) {
      damping *= 10.0;
      continue;
    }
    const double gain = 1.0 - there.cost / system.cost;
    state_ = next;
    system = there;
    damping *= 0.1;
    if (gain < kMinGainShare) break;
  }
  const double contrast = std::abs(state_[kLight + 1]);
  const double noise = std::sqrt(system.squares / std::max(1, system.pixels));
  residual_ = noise / contrast;
  noise_px_ = noise * spread(system.normal);
  return true;
}

double Fit::spread(const Normal& normal) const {
  bool solved = false;
  const Normal inverse = normal.inv(cv::DECOMP_CHOLESKY, &solved);
  if (!solved) return std::numeric_limits<double>::infinity();
  const cv::Matx<double, kPlace, kPlace> uncertainty =
      inverse.get_minor<kPlace, kPlace>(0, 0);
  double sum = 0.0;
  const cv::Matx33d h = homography(state_);
  for (const auto& corner : kCornerSides) {
    const cv::Vec3d cell(half_cells_ * corner[0], half_cells_ * corner[1], 1.0);
    const cv::Vec3d p = h * cell;
    const double w = 1.0 / p[2];
    cv::Matx<double, 2, kPlace> slope = cv::Matx<double, 2, kPlace>::zeros();
    for (int axis = 0; axis < 2; ++axis) {
      for (int i = 0; i < 3; ++i) slope(axis, 3 * axis + i) = w * cell[i];
      for (int i = 0; i < 2; ++i) slope(axis, 6 + i) = -w * w * p[axis] * cell[i];
    }
    sum += cv::trace(slope * uncertainty * slope.t());
  }
  return std::sqrt(sum / 8.0);
}

Alignment Fit::answer() const {
  const cv::Matx33d image_from_cell = homography(state_);
  Alignment alignment;
  for (std::size_t i = 0; i < 4; ++i) {
    const cv::Vec3d p = image_from_cell * cv::Vec3d(half_cells_ * kCornerSides[i][0],
                                                    half_cells_ * kCornerSides[i][1],
                                                    1.0);
    alignment.corners_px[i] = middle_px_ + glm::dvec2(p[0], p[1]) / p[2];
  }
  alignment.blur_px = std::exp(state_[kBlur]);
  alignment.residual = residual_;
  alignment.sigma_px = aligned_corner_sigma_px(
      noise_px_, residual_, alignment.blur_px, state_[kLight] + state_[kLight + 1]);
  return alignment;
}

}  // namespace

std::optional<Alignment> align_pattern(const GrayFrame& frame,
                                       const TagPattern& pattern,
                                       const std::array<glm::dvec2, 4>& corners_px,
                                       double slack_px,
                                       AlignScratch& scratch) {
  MAREY_ASSERT(pattern.cells - 2 * pattern.margin_cells >= 4);
  Fit fit(frame, pattern, corners_px, scratch);
  if (!fit.run()) return std::nullopt;
  const Alignment alignment = fit.answer();
  // The fit converged elsewhere: cells away, or to another object.
  const double side_px =
      glm::distance(corners_px[0], corners_px[2]) / std::numbers::sqrt2;
  const double cell_px = side_px / (pattern.cells - 2 * pattern.margin_cells);
  constexpr double kMaxResidual = 0.25;
  // The blur biases an edge search inward, most if light was clipped.
  constexpr double kBiasPerBlur = 2.0;
  const double max_px =
      std::min(1.5 * cell_px, slack_px + kBiasPerBlur * alignment.blur_px);
  // Written so that NaN is rejected.
  if (!(alignment.residual <= kMaxResidual)) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    const double moved_px = glm::distance(alignment.corners_px[i], corners_px[i]);
    if (!(moved_px <= max_px)) return std::nullopt;
  }
  return alignment;
}

}  // namespace marey::capture
