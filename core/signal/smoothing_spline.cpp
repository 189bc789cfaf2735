// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/smoothing_spline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"

namespace marey {
namespace {

constexpr std::size_t size_of_order(int order) {
  return static_cast<std::size_t>(order);
}

/// Coefficients of the m-th forward difference: Delta^m y_k = sum of s_j y_(k + j).
template <int Order>
constexpr std::array<double, Order + 1> spline_differences() {
  if constexpr (Order == 2) {
    return {1.0, -2.0, 1.0};
  } else {
    return {-1.0, 3.0, -3.0, 1.0};
  }
}

/// R(k, k + p): the centred B-spline of order 2m at p.
template <int Order>
constexpr std::array<double, Order + 1> spline_gram() {
  if constexpr (Order == 2) {
    return {4.0 / 6.0, 1.0 / 6.0, 0.0};
  } else {
    return {66.0 / 120.0, 26.0 / 120.0, 1.0 / 120.0, 0.0};
  }
}

/// Row k of D W^-1 D', its entries (k, k + p).
template <int Order>
std::array<double, Order + 1> spline_penalty_row(const double* inverse_weights,
                                                 std::size_t k) {
  constexpr auto kDifferences = spline_differences<Order>();
  std::array<double, Order + 1> row{};
  for (std::size_t p = 0; p <= Order; ++p) {
    for (std::size_t j = p; j <= Order; ++j) {
      row[p] += kDifferences[j] * kDifferences[j - p] * inverse_weights[k + j];
    }
  }
  return row;
}

}  // namespace

double max_spline_penalty(SplineOptions options) {
  return options.order == 2 ? 1e9 : 1e10;
}

double half_power_hz(double penalty, double rate_hz, SplineOptions options) {
  MAREY_ASSERT(penalty > 0.0 && (options.order == 2 || options.order == 3));
  const double w = std::pow((std::numbers::sqrt2 - 1.0) / penalty, 0.5 / options.order);
  return w * rate_hz / (2.0 * std::numbers::pi);
}

double penalty_of_half_power(double cutoff_hz, double rate_hz, SplineOptions options) {
  MAREY_ASSERT(cutoff_hz > 0.0 && (options.order == 2 || options.order == 3));
  const double w = 2.0 * std::numbers::pi * cutoff_hz / rate_hz;
  return (std::numbers::sqrt2 - 1.0) / std::pow(w, 2.0 * options.order);
}

SmoothingSpline::SmoothingSpline(std::size_t samples,
                                 SplineOptions options,
                                 std::span<const double> weights)
    : options_(options), inverse_weights_(samples, 1.0) {
  MAREY_ASSERT(options.order == 2 || options.order == 3);
  const std::size_t order = size_of_order(options.order);
  MAREY_ASSERT(samples > 2 * order);
  MAREY_ASSERT(weights.empty() || weights.size() == samples);
  for (std::size_t i = 0; i < weights.size(); ++i) inverse_weights_[i] = 1.0 / weights[i];
  rows_.resize(samples - order);
  work_.assign((samples + order) * kLanes, 0.0);
}

void SmoothingSpline::set_penalty(double penalty) {
  MAREY_ASSERT(penalty > 0.0 && penalty <= max_spline_penalty(options_));
  penalty_ = penalty;
  if (options_.order == 2) {
    factorise<2>();
    compute_residual_freedom<2>();
  } else {
    factorise<3>();
    compute_residual_freedom<3>();
  }
}

/// L D L' of the banded matrix. `scaled` holds the last rows of L D.
template <int Order>
void SmoothingSpline::factorise() {
  constexpr auto kGram = spline_gram<Order>();
  // Entries (i, i - q) of the matrix come from row i - q, so the rows ahead are kept.
  std::array<std::array<double, Order + 1>, Order + 1> ahead{};
  std::array<double, Order + 1> d{};  // d[q]: D of row i - q.
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (std::size_t q = Order; q > 0; --q) {
      ahead[q] = ahead[q - 1];
      d[q] = d[q - 1];
    }
    ahead[0] = spline_penalty_row<Order>(inverse_weights_.data(), i);
    for (std::size_t p = 0; p <= Order; ++p) {
      ahead[0][p] = kGram[p] + penalty_ * ahead[0][p];
    }
    Row& row = rows_[i];
    row = {};
    double pivot = ahead[0][0];
    const std::size_t band = std::min<std::size_t>(Order, i);
    for (std::size_t q = band; q > 0; --q) {
      double entry = ahead[q][q];
      for (std::size_t r = q + 1; r <= band; ++r) {
        entry -= row[r] * d[r] * rows_[i - q][r - q];
      }
      row[q] = entry / d[q];
      pivot -= row[q] * entry;
    }
    d[0] = pivot;
    row[0] = 1.0 / pivot;
  }
}

/// Computes n - trace in two ways, of which it takes the one without cancellation:
/// penalty * tr(M^-1 D W^-1 D') for small penalties, n - m - tr(M^-1 R) for large ones.
template <int Order>
void SmoothingSpline::compute_residual_freedom() {
  constexpr auto kGram = spline_gram<Order>();
  using Band = std::array<double, Order + 1>;
  std::array<Band, Order + 1> inverse{};  // inverse[k][p]: entry (i + k, i + k + p).
  double smooth = 0.0;
  double rough = 0.0;
  for (std::size_t i = rows_.size(); i-- > 0;) {
    for (std::size_t k = Order; k > 0; --k) inverse[k] = inverse[k - 1];
    std::array<double, Order + 1> l{};  // l[k] = L(i + k, i).
    for (std::size_t k = 1; k <= Order && i + k < rows_.size(); ++k) {
      l[k] = rows_[i + k][k];
    }
    for (std::size_t p = 1; p <= Order; ++p) {
      double sum = 0.0;
      for (std::size_t k = 1; k <= Order; ++k) {
        sum += l[k] * (k <= p ? inverse[k][p - k] : inverse[p][k - p]);
      }
      inverse[0][p] = -sum;
    }
    double diagonal = rows_[i][0];
    for (std::size_t k = 1; k <= Order; ++k) diagonal -= l[k] * inverse[0][k];
    inverse[0][0] = diagonal;

    const Band row = spline_penalty_row<Order>(inverse_weights_.data(), i);
    smooth += diagonal * kGram[0];
    rough += diagonal * row[0];
    for (std::size_t p = 1; p <= Order && i + p < rows_.size(); ++p) {
      smooth += 2.0 * inverse[0][p] * kGram[p];
      rough += 2.0 * inverse[0][p] * row[p];
    }
  }
  const double rows = static_cast<double>(rows_.size());
  residual_freedom_ = smooth > 0.5 * rows ? penalty_ * rough : rows - smooth;
}

template <int Order, std::size_t Lanes>
void SmoothingSpline::solve(const std::array<const double*, Lanes>& channels) {
  constexpr auto kDifferences = spline_differences<Order>();
  const std::size_t rows = rows_.size();
  double* const c = work_.data() + Order * Lanes;
  std::fill(work_.data(), c, 0.0);
  std::fill_n(c + rows * Lanes, Order * Lanes, 0.0);
  for (std::size_t i = 0; i < rows; ++i) {
    const Row& row = rows_[i];
    double* const now = c + i * Lanes;
    for (std::size_t lane = 0; lane < Lanes; ++lane) {
      double value = 0.0;
      for (std::size_t j = 0; j <= Order; ++j)
        value += kDifferences[j] * channels[lane][i + j];
      for (std::size_t q = Order; q > 0; --q) value -= row[q] * (now - q * Lanes)[lane];
      now[lane] = value;
    }
  }
  for (std::size_t i = rows; i-- > 0;) {
    std::array<double, Order + 1> l{};
    for (std::size_t k = 1; k <= Order && i + k < rows; ++k) l[k] = rows_[i + k][k];
    double* const now = c + i * Lanes;
    for (std::size_t lane = 0; lane < Lanes; ++lane) {
      double value = now[lane] * rows_[i][0];
      for (std::size_t k = Order; k > 0; --k) value -= l[k] * (now + k * Lanes)[lane];
      now[lane] = value;
    }
  }
}

template <int Order>
void SmoothingSpline::subtract_residuals(std::span<const double> channel,
                                         std::span<double> fitted) {
  constexpr auto kDifferences = spline_differences<Order>();
  for (std::size_t i = 0; i < channel.size(); ++i) {
    double sum = 0.0;  // (D' c)_i; work_[i + Order - j] is c_(i - j).
    for (std::size_t j = 0; j <= Order; ++j)
      sum += kDifferences[j] * work_[i + Order - j];
    fitted[i] = channel[i] - penalty_ * inverse_weights_[i] * sum;
  }
}

template <int Order, std::size_t Lanes>
std::array<double, Lanes> SmoothingSpline::residual_squares() const {
  constexpr auto kDifferences = spline_differences<Order>();
  std::array<double, Lanes> squares{};
  for (std::size_t i = 0; i < samples(); ++i) {
    for (std::size_t lane = 0; lane < Lanes; ++lane) {
      double sum = 0.0;
      for (std::size_t j = 0; j <= Order; ++j) {
        sum += kDifferences[j] * work_[(i + Order - j) * Lanes + lane];
      }
      squares[lane] += sum * sum * inverse_weights_[i];
    }
  }
  for (double& value : squares) value *= penalty_ * penalty_;
  return squares;
}

SplineFit SmoothingSpline::rated(double residual_squares) const {
  SplineFit fit;
  fit.residual_squares = residual_squares;
  fit.gcv = static_cast<double>(samples()) * residual_squares /
            (residual_freedom_ * residual_freedom_);
  fit.noise_sigma = std::sqrt(residual_squares / residual_freedom_);
  return fit;
}

SplineFit SmoothingSpline::fit(std::span<const double> channel,
                               std::span<double> fitted) {
  MAREY_ASSERT(penalty_ > 0.0);
  MAREY_ASSERT(channel.size() == samples() && fitted.size() == samples());
  const std::array<const double*, 1> one{channel.data()};
  if (options_.order == 2) {
    solve<2, 1>(one);
    subtract_residuals<2>(channel, fitted);
    return rated(residual_squares<2, 1>()[0]);
  }
  solve<3, 1>(one);
  subtract_residuals<3>(channel, fitted);
  return rated(residual_squares<3, 1>()[0]);
}

template <int Order>
void SmoothingSpline::score_all(std::span<const std::span<const double>> channels,
                                std::span<SplineFit> scores) {
  for (std::size_t first = 0; first < channels.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, channels.size() - first);
    std::array<const double*, kLanes> batch{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // A batch that is not full repeats its last channel.
      const auto& channel = channels[first + std::min(lane, count - 1)];
      MAREY_ASSERT(channel.size() == samples());
      batch[lane] = channel.data();
    }
    solve<Order, kLanes>(batch);
    const auto squares = residual_squares<Order, kLanes>();
    for (std::size_t lane = 0; lane < count; ++lane) {
      scores[first + lane] = rated(squares[lane]);
    }
  }
}

void SmoothingSpline::score(std::span<const std::span<const double>> channels,
                            std::span<SplineFit> scores) {
  MAREY_ASSERT(penalty_ > 0.0 && scores.size() == channels.size());
  if (options_.order == 2) {
    score_all<2>(channels, scores);
  } else {
    score_all<3>(channels, scores);
  }
}

std::span<const double> SmoothingSpline::top_derivative() const {
  return std::span(work_).subspan(size_of_order(options_.order), rows_.size());
}

}  // namespace marey
