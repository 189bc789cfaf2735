// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/signal/butterworth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/base/assert.h"

namespace marey::edit {
namespace {

constexpr double kButterworthPadding_s = 0.25;
constexpr std::size_t kResidualCutoffs = 60;
constexpr std::size_t kMinResidualSamples = 20;
/// A straight line fits the end of the residual curve to this share of its variance.
constexpr double kResidualLinearity = 0.95;

/// One pass of the 2nd order: y = b0 (x0 + 2 x1 + x2) - a1 y1 - a2 y2.
struct ButterworthPass {
  double b0 = 0.0;
  double a1 = 0.0;
  double a2 = 0.0;
};

ButterworthPass butterworth_pass(double cutoff_hz, double rate_hz) {
  const double both_passes = std::pow(std::numbers::sqrt2 - 1.0, 0.25);
  const double w = std::tan(std::numbers::pi * cutoff_hz / rate_hz) / both_passes;
  const double scale = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
  return {w * w * scale,
          2.0 * (w * w - 1.0) * scale,
          (1.0 - std::numbers::sqrt2 * w + w * w) * scale};
}

/// Filters from `begin` to `end`, either direction, starting in the steady state.
template <class Iterator>
void run_butterworth(const ButterworthPass& pass, Iterator begin, Iterator end) {
  double x1 = *begin;
  double x2 = x1;
  double y1 = x1;
  double y2 = x1;
  for (Iterator at = begin; at != end; ++at) {
    const double x0 = *at;
    const double y0 = pass.b0 * (x0 + 2.0 * x1 + x2) - pass.a1 * y1 - pass.a2 * y2;
    x2 = x1;
    x1 = x0;
    y2 = y1;
    y1 = y0;
    *at = y0;
  }
}

double residual_rms(std::span<const double> channel,
                    double cutoff_hz,
                    double rate_hz,
                    std::vector<double>& filtered) {
  filtered.assign(channel.begin(), channel.end());
  filter_butterworth(filtered, cutoff_hz, rate_hz);
  double squares = 0.0;
  for (std::size_t i = 0; i < channel.size(); ++i) {
    squares += (channel[i] - filtered[i]) * (channel[i] - filtered[i]);
  }
  return std::sqrt(squares / static_cast<double>(channel.size()));
}

struct ResidualLine {
  double at_zero = 0.0;
  double determination = 0.0;  ///< Share of the variance that the line explains.
};

ResidualLine fit_residual_line(std::span<const double> x, std::span<const double> y) {
  const double count = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (yy <= 0.0) return {mean_y, 0.0};
  return {mean_y - xy / xx * mean_x, xy * xy / (xx * yy)};
}

}  // namespace

void filter_butterworth(std::span<double> channel, double cutoff_hz, double rate_hz) {
  MAREY_ASSERT(cutoff_hz > 0.0 && cutoff_hz < 0.5 * rate_hz);
  if (channel.size() < 2) return;
  const std::size_t samples = channel.size();
  const auto padding = std::min<std::size_t>(
      static_cast<std::size_t>(std::lround(kButterworthPadding_s * rate_hz)),
      samples - 1);
  std::vector<double> extended(samples + 2 * padding);
  for (std::size_t i = 0; i < padding; ++i) {
    extended[i] = 2.0 * channel.front() - channel[padding - i];
    extended[padding + samples + i] = 2.0 * channel.back() - channel[samples - 2 - i];
  }
  std::copy(channel.begin(),
            channel.end(),
            extended.begin() + static_cast<std::ptrdiff_t>(padding));
  const ButterworthPass pass = butterworth_pass(cutoff_hz, rate_hz);
  run_butterworth(pass, extended.begin(), extended.end());
  run_butterworth(pass, extended.rbegin(), extended.rend());
  std::copy_n(
      extended.begin() + static_cast<std::ptrdiff_t>(padding), samples, channel.begin());
}

double yu_cutoff_hz(double rate_hz) {
  MAREY_ASSERT(rate_hz > 0.0 && rate_hz <= 1183.0);
  return 0.071 * rate_hz - 0.00003 * rate_hz * rate_hz;
}

std::optional<double> winter_cutoff_hz(std::span<const double> channel, double rate_hz) {
  if (channel.size() < kMinResidualSamples) return std::nullopt;
  std::vector<double> cutoffs;
  std::vector<double> residuals;
  std::vector<double> filtered;
  for (std::size_t i = 1; i <= kResidualCutoffs; ++i) {
    cutoffs.push_back(0.25 * rate_hz * static_cast<double>(i) / kResidualCutoffs);
    residuals.push_back(residual_rms(channel, cutoffs.back(), rate_hz, filtered));
  }
  double size = 0.0;
  for (const double value : channel) size = std::max(size, std::abs(value));
  if (residuals.front() <= 1e-12 * size) return std::nullopt;  // Constant.
  // The longest straight end, at least a quarter of the curve.
  std::optional<double> noise;
  for (std::size_t first = 0; first <= kResidualCutoffs * 3 / 4 && !noise; ++first) {
    const ResidualLine line = fit_residual_line(std::span(cutoffs).subspan(first),
                                                std::span(residuals).subspan(first));
    if (line.determination >= kResidualLinearity) noise = line.at_zero;
  }
  if (!noise) return std::nullopt;
  if (residuals.front() <= *noise) return cutoffs.front();
  for (std::size_t i = 1; i < kResidualCutoffs; ++i) {
    if (residuals[i] > *noise) continue;
    const double share = (residuals[i - 1] - *noise) / (residuals[i - 1] - residuals[i]);
    return cutoffs[i - 1] + share * (cutoffs[i] - cutoffs[i - 1]);
  }
  return std::nullopt;
}

}  // namespace marey::edit
