// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/descent_arrest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/assert.h"

namespace marey::retarget {
namespace {

constexpr double kBefore_s = 0.07;
constexpr double kAfter_s = 0.06;
constexpr double kMinSpan_frames = 3.5;
constexpr double kSearch_s = 0.04;
constexpr double kStep_s = 0.002;
constexpr int kMinFrames = 3;  // On either side.
// A smaller step may be noise.
constexpr double kMinStandardErrors = 6.0;

// Weighted fit of two parabolas with a common value and slope.
struct StepFit {
  double change_m_per_s2 = 0.0;
  double gain_m2 = 0.0;  // Squared error that the step explains; negative if downward.
  double standard_error_m_per_s2 = 0.0;
};

using Column = std::vector<double>;

double dot(const Column& a, const Column& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void subtract(double factor, const Column& a, Column& from) {
  for (std::size_t i = 0; i < a.size(); ++i) from[i] -= factor * a[i];
}

std::optional<StepFit> fit_step(std::span<const double> height_m,
                                double hz,
                                double frame) {
  const double before_s = std::max(kBefore_s, kMinSpan_frames / hz);
  const double after_s = std::max(kAfter_s, kMinSpan_frames / hz);
  const int first = std::max(0, static_cast<int>(std::ceil(frame - before_s * hz)));
  const int last = std::min(static_cast<int>(height_m.size()) - 1,
                            static_cast<int>(std::floor(frame + after_s * hz)));
  if (frame - first < kMinFrames - 1 || last - frame < kMinFrames - 1) {
    return std::nullopt;
  }
  std::array<Column, 3> parabola;
  Column step;
  Column height;
  for (int t = first; t <= last; ++t) {
    const double s = (t - frame) / hz;
    const double share = s < 0.0 ? s / before_s : s / after_s;
    const double w = std::sqrt(std::max(0.0, 1.0 - share * share));
    parabola[0].push_back(w);
    parabola[1].push_back(w * s);
    parabola[2].push_back(w * s * s);
    step.push_back(s > 0.0 ? 0.5 * w * s * s : 0.0);
    height.push_back(w * height_m[static_cast<std::size_t>(t)]);
  }
  // What a single parabola explains is removed from the step and from the heights.
  for (std::size_t i = 0; i < parabola.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      subtract(dot(parabola[j], parabola[i]), parabola[j], parabola[i]);
    }
    const double norm = std::sqrt(dot(parabola[i], parabola[i]));
    if (norm <= 0.0) return std::nullopt;
    for (double& x : parabola[i]) x /= norm;
    subtract(dot(parabola[i], step), parabola[i], step);
    subtract(dot(parabola[i], height), parabola[i], height);
  }
  const double norm2 = dot(step, step);
  if (norm2 <= 0.0) return std::nullopt;
  StepFit fit;
  fit.change_m_per_s2 = dot(step, height) / norm2;
  fit.gain_m2 = fit.change_m_per_s2 * std::abs(fit.change_m_per_s2) * norm2;
  const double left_m2 = std::max(0.0, dot(height, height) - std::abs(fit.gain_m2));
  const auto free = static_cast<double>(height.size() - parabola.size() - 1);
  fit.standard_error_m_per_s2 = std::sqrt(left_m2 / (std::max(1.0, free) * norm2));
  return fit;
}

}  // namespace

std::optional<DescentArrest> find_descent_arrest(std::span<const double> height_m,
                                                 double hz,
                                                 double near_frame) {
  MAREY_ASSERT(hz > 0.0);
  const int reach = static_cast<int>(std::lround(kSearch_s / kStep_s));
  std::vector<std::optional<StepFit>> fits;
  for (int i = -reach; i <= reach; ++i) {
    fits.push_back(fit_step(height_m, hz, near_frame + i * kStep_s * hz));
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 1; i + 1 < fits.size(); ++i) {
    if (!fits[i - 1] || !fits[i] || !fits[i + 1] || fits[i]->gain_m2 <= 0.0) continue;
    const double gain_m2 = fits[i]->gain_m2;
    if (gain_m2 < fits[i - 1]->gain_m2 || gain_m2 < fits[i + 1]->gain_m2) continue;
    if (!best || gain_m2 > fits[*best]->gain_m2) best = i;
  }
  if (!best || fits[*best]->change_m_per_s2 <
                   kMinStandardErrors * fits[*best]->standard_error_m_per_s2) {
    return std::nullopt;
  }
  // The peak between candidates, of the parabola through three of them.
  const double left = fits[*best - 1]->gain_m2;
  const double middle = fits[*best]->gain_m2;
  const double right = fits[*best + 1]->gain_m2;
  const double bend = left - 2.0 * middle + right;
  const double offset = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
  const double step = static_cast<double>(*best) - reach + offset;
  return DescentArrest{near_frame + step * kStep_s * hz, fits[*best]->change_m_per_s2};
}

}  // namespace marey::retarget
