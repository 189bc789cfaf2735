// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace marey {

/// Kind of a smoothing spline.
struct SplineOptions {
  /// Derivative that is penalised. 2: cubic spline. 3: quintic spline, for accelerations
  /// (Woltring 1986).
  int order = 2;
};

/// Returns the largest penalty for which double precision keeps the fit within 1e-6 of
/// the samples' range. At 120 Hz it is a half-power cut-off of 0.09 Hz (order 2) or 0.36
/// Hz (order 3).
[[nodiscard]] double max_spline_penalty(SplineOptions options);

/// Returns the frequency [Hz] at which the spline halves the power of a signal (gain
/// 0.707), for unit weights. The gain is 1 / (1 + penalty * w^(2 * order)), with w in
/// radians per sample (Craven & Wahba 1979; within 1 % below half the Nyquist frequency).
/// Preconditions: penalty > 0; order 2 or 3.
[[nodiscard]] double half_power_hz(double penalty, double rate_hz, SplineOptions options);

/// Inverse of half_power_hz(). Precondition: cutoff_hz > 0.
[[nodiscard]] double penalty_of_half_power(double cutoff_hz,
                                           double rate_hz,
                                           SplineOptions options);

/// Scores of a fitted channel.
struct SplineFit {
  /// Weighted sum of the squared residuals. [unit of the samples, squared]
  double residual_squares = 0.0;
  /// Generalised cross-validation: n * residual squares / (n - trace)^2.
  double gcv = 0.0;
  /// Estimate of the noise's sigma at weight 1: the root of residual squares / (n -
  /// trace) (Wahba 1983).
  double noise_sigma = 0.0;
};

/// Natural smoothing spline of equally spaced samples at unit distance:
/// minimises sum of w_i (y_i - f(i))^2 + penalty * integral of (f^(m))^2, m the order.
///
/// Solves (R + penalty * D W^-1 D') c = D y, the banded system of Reinsch (1967), where D
/// takes m-th differences, R holds the B-spline of order 2m at the integers, and c are
/// the B-spline coefficients of f^(m). The trace of the influence matrix is exact, from
/// the band of the inverse (Hutchinson & de Hoog 1985).
///
/// One factorisation serves all channels with these weights. All methods are linear in
/// the number of samples and allocate nothing.
class SmoothingSpline {
 public:
  /// Precondition: order 2 or 3; at least 2 * order + 1 samples; weights empty (all 1),
  /// or one per sample, each above 0.
  explicit SmoothingSpline(std::size_t samples,
                           SplineOptions options = {},
                           std::span<const double> weights = {});

  [[nodiscard]] std::size_t samples() const { return inverse_weights_.size(); }
  [[nodiscard]] SplineOptions options() const { return options_; }

  /// Factorises the system and computes the trace. Precondition: 0 < penalty <=
  /// max_spline_penalty().
  void set_penalty(double penalty);
  [[nodiscard]] double penalty() const { return penalty_; }

  /// Returns n - trace of the influence matrix: the residuals' degrees of freedom.
  /// Accurate for small penalties too. Precondition: set_penalty() was called.
  [[nodiscard]] double residual_freedom() const { return residual_freedom_; }

  /// Fits one channel and writes the spline's values at the samples into `fitted`, which
  /// may be the channel itself. Preconditions: set_penalty() was called; both have
  /// samples() elements.
  SplineFit fit(std::span<const double> channel, std::span<double> fitted);

  /// Scores channels without writing their fits; about three times as fast as fit(). The
  /// scores equal those of fit() to the bit. Preconditions: as for fit(); `scores` has
  /// one element per channel.
  void score(std::span<const std::span<const double>> channels,
             std::span<SplineFit> scores);

  /// Returns the coefficients c of f^(m) of the channel fitted last, n - m of them: f^(m)
  /// at t is the sum of c_k N(t - k), N the B-spline of order m on [0, m].
  [[nodiscard]] std::span<const double> top_derivative() const;

 private:
  static constexpr std::size_t kMaxOrder = 3;
  static constexpr std::size_t kLanes = 4;
  /// Row i of the factors L D L': 1 / D_i, then L(i, i - 1), L(i, i - 2), L(i, i - 3).
  using Row = std::array<double, kMaxOrder + 1>;

  template <int Order>
  void factorise();
  template <int Order>
  void compute_residual_freedom();
  template <int Order, std::size_t Lanes>
  void solve(const std::array<const double*, Lanes>& channels);
  template <int Order>
  void subtract_residuals(std::span<const double> channel, std::span<double> fitted);
  template <int Order, std::size_t Lanes>
  [[nodiscard]] std::array<double, Lanes> residual_squares() const;
  template <int Order>
  void score_all(std::span<const std::span<const double>> channels,
                 std::span<SplineFit> scores);
  [[nodiscard]] SplineFit rated(double residual_squares) const;

  SplineOptions options_;
  double penalty_ = 0.0;
  double residual_freedom_ = 0.0;
  std::vector<double> inverse_weights_;
  std::vector<Row> rows_;
  /// c of the channels of a batch, interleaved; preceded and followed by `order` zeros of
  /// each.
  std::vector<double> work_;
};

}  // namespace marey
