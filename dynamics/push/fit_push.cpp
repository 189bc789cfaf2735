// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/fit_push.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "dynamics/push/force_splines.h"

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

constexpr std::size_t kMinPositions = 8;
/// Knots of the force are half a period of the cut-off apart.
constexpr double kKnotsPerPeriod = 2.0;
constexpr int kMinCoefficients = 8;
constexpr int kMaxCoefficients = 200;
constexpr double kSamplesPerPosition = 2.0;
constexpr double kTwoPi = 6.283185307179586;

/// Dense symmetric system with a few hundred unknowns at most.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t size)
      : size_(size), matrix_(size * size, 0.0), right_(size, 0.0) {}

  void add(std::size_t i, std::size_t j, double value) {
    matrix_[i * size_ + j] += value;
  }
  void add_observation(const std::vector<double>& row, double value, double weight) {
    for (std::size_t i = 0; i < size_; ++i) {
      right_[i] += weight * row[i] * value;
      for (std::size_t j = 0; j < size_; ++j) add(i, j, weight * row[i] * row[j]);
    }
  }
  /// Sets an unknown to 0.
  void fix(std::size_t i) {
    for (std::size_t j = 0; j < size_; ++j) {
      matrix_[i * size_ + j] = matrix_[j * size_ + i] = 0.0;
    }
    matrix_[i * size_ + i] = 1.0;
    right_[i] = 0.0;
  }
  /// Solves by Cholesky factorisation. nullopt: not positive definite.
  [[nodiscard]] std::optional<std::vector<double>> solve() {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = matrix_[i * size_ + j];
        for (std::size_t k = 0; k < j; ++k) {
          sum -= matrix_[i * size_ + k] * matrix_[j * size_ + k];
        }
        if (i != j) {
          matrix_[i * size_ + j] = sum / matrix_[j * size_ + j];
        } else if (sum > 0.0) {
          matrix_[i * size_ + i] = std::sqrt(sum);
        } else {
          return std::nullopt;
        }
      }
    }
    std::vector<double> out = right_;
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t k = 0; k < i; ++k) out[i] -= matrix_[i * size_ + k] * out[k];
      out[i] /= matrix_[i * size_ + i];
    }
    for (std::size_t i = size_; i-- > 0;) {
      for (std::size_t k = i + 1; k < size_; ++k) {
        out[i] -= matrix_[k * size_ + i] * out[k];
      }
      out[i] /= matrix_[i * size_ + i];
    }
    return out;
  }

 private:
  std::size_t size_;
  std::vector<double> matrix_;
  std::vector<double> right_;
};

/// Unknowns: position and velocity at the start (per duration), force coefficients times
/// the squared duration. All are in metres.
constexpr std::size_t kFirstCoefficient = 2;

double dot_with(const std::vector<double>& row, std::span<const double> coefficients) {
  double sum = 0.0;
  for (std::size_t j = 0; j < coefficients.size(); ++j) sum += row[j] * coefficients[j];
  return sum;
}

/// Adds the penalty on the second derivative: the gain of the fit is 1/2 at the cut-off.
void add_penalty(const ForceSplines& splines,
                 double duration_s,
                 double cutoff_hz,
                 NormalEquations& equations) {
  const auto count = static_cast<std::size_t>(splines.count());
  const auto rough = splines.roughness_matrix(1.0);
  const auto plain = splines.roughness_matrix(0.0);
  // 1 / (1 + penalty w^8) for a curve whose fourth derivative is penalised.
  const double penalty = std::pow(kTwoPi * cutoff_hz * duration_s, -8.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      equations.add(kFirstCoefficient + i,
                    kFirstCoefficient + j,
                    penalty * (rough[i * count + j] - plain[i * count + j]));
    }
  }
}

}  // namespace

std::optional<PushFit> fit_push(std::span<const double> time_s,
                                std::span<const double> position_m,
                                double duration_s,
                                const FitPushOptions& options) {
  MAREY_ASSERT(time_s.size() == position_m.size());
  MAREY_ASSERT(duration_s > 0.0 && options.cutoff_hz > 0.0);
  const std::size_t frames = time_s.size();
  if (frames < kMinPositions) return std::nullopt;
  const double gravity_m_s2 = options.is_horizontal ? 0.0 : options.gravity_m_s2;
  const double squared_s2 = duration_s * duration_s;
  const int wanted =
      static_cast<int>(std::round(duration_s * kKnotsPerPeriod * options.cutoff_hz)) + 3;
  const ForceSplines splines(std::clamp(wanted, kMinCoefficients, kMaxCoefficients));
  const auto count = static_cast<std::size_t>(splines.count());

  NormalEquations equations(kFirstCoefficient + count);
  std::vector<double> row(kFirstCoefficient + count);
  const std::span<double> spline_row = std::span(row).subspan(kFirstCoefficient);
  const auto row_at = [&](double x) {
    row[0] = 1.0;
    row[1] = x;
    splines.write_double_integrals(x, spline_row);
  };
  const double weight =
      (time_s.back() - time_s.front()) / (duration_s * static_cast<double>(frames - 1));
  for (std::size_t i = 0; i < frames; ++i) {
    if (!std::isfinite(position_m[i])) return std::nullopt;
    row_at(time_s[i] / duration_s);
    const double fall_m = 0.5 * gravity_m_s2 * time_s[i] * time_s[i];
    equations.add_observation(row, position_m[i] + fall_m, weight);
  }
  add_penalty(splines, duration_s, options.cutoff_hz, equations);
  if (options.from_flight) equations.fix(kFirstCoefficient);
  if (options.to_flight) equations.fix(kFirstCoefficient + count - 1);
  const auto solved = equations.solve();
  if (!solved) return std::nullopt;

  PushFit out;
  for (std::size_t i = 0; i < frames; ++i) {
    row_at(time_s[i] / duration_s);
    const double off_m = dot_with(row, *solved) -
                         0.5 * gravity_m_s2 * time_s[i] * time_s[i] - position_m[i];
    out.rms_m += off_m * off_m / static_cast<double>(frames);
  }
  out.rms_m = std::sqrt(out.rms_m);

  row_at(1.0);
  out.ends.start_m = (*solved)[0];
  out.ends.start_m_s = (*solved)[1] / duration_s;
  out.ends.end_m = dot_with(row, *solved) - 0.5 * gravity_m_s2 * squared_s2;
  row[0] = 0.0;
  splines.write_integrals(1.0, spline_row);
  out.ends.end_m_s = dot_with(row, *solved) / duration_s - gravity_m_s2 * duration_s;
  out.ends.duration_s = duration_s;
  out.ends.gravity_m_s2 = options.gravity_m_s2;

  const auto samples =
      static_cast<std::size_t>(kSamplesPerPosition * static_cast<double>(frames)) + 1;
  std::vector<double> force(samples);
  const std::span<const double> coefficients =
      std::span(*solved).subspan(kFirstCoefficient);
  row.resize(count);
  for (std::size_t k = 0; k < samples; ++k) {
    splines.write_values(static_cast<double>(k) / static_cast<double>(samples - 1), row);
    force[k] = dot_with(row, coefficients) / squared_s2;
    if (!options.is_horizontal) force[k] = std::max(force[k], 0.0);
  }
  out.reference = make_push_reference(duration_s, std::move(force));
  return out;
}

}  // namespace marey::dynamics
