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

constexpr double kBefore_s = 0.08;
constexpr double kAfter_s = 0.07;
constexpr double kMinSpan_frames = 3.5;
constexpr double kSearch_s = 0.05;
constexpr double kRefine_s = 0.012;
constexpr double kStep_s = 0.002;
constexpr int kMinFrames = 3;  // On either side.
// A smaller step may be noise.
constexpr double kMinStandardErrors = 4.0;

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

// Fit with a step at `frame`, weighted around `middle`.
std::optional<StepFit> fit_step(std::span<const double> height_m,
                                double hz,
                                double middle,
                                double frame) {
  const double before_s = std::max(kBefore_s, kMinSpan_frames / hz);
  const double after_s = std::max(kAfter_s, kMinSpan_frames / hz);
  const int first = std::max(0, static_cast<int>(std::ceil(middle - before_s * hz)));
  const int last = std::min(static_cast<int>(height_m.size()) - 1,
                            static_cast<int>(std::floor(middle + after_s * hz)));
  if (frame - first < kMinFrames - 1 || last - frame < kMinFrames - 1) {
    return std::nullopt;
  }
  std::array<Column, 3> parabola;
  Column step;
  Column height;
  for (int t = first; t <= last; ++t) {
    const double s = (t - frame) / hz;
    const double from_middle_s = (t - middle) / hz;
    const double share = from_middle_s / (from_middle_s < 0.0 ? before_s : after_s);
    const double w = std::max(0.0, 1.0 - share * share);
    parabola[0].push_back(w);
    parabola[1].push_back(w * s);
    parabola[2].push_back(w * s * s);
    step.push_back(s > 0.0 ? 0.5 * w * s * s : 0.0);
    height.push_back(w * height_m[static_cast<std::size_t>(t)]);
  }
  // Removes from the step and from the heights the part that one parabola explains.
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

// Candidate of a search, in steps from its start, and its fit.
struct Peak {
  double step = 0.0;
  StepFit fit;
};

// Highest local maximum of the gain, between candidates.
std::optional<Peak> highest_peak(const std::vector<std::optional<StepFit>>& fits) {
  std::optional<Peak> best;
  for (std::size_t i = 1; i + 1 < fits.size(); ++i) {
    if (!fits[i - 1] || !fits[i] || !fits[i + 1] || fits[i]->gain_m2 <= 0.0) continue;
    const double left = fits[i - 1]->gain_m2;
    const double gain_m2 = fits[i]->gain_m2;
    const double right = fits[i + 1]->gain_m2;
    if (gain_m2 < left || gain_m2 < right) continue;
    if (best && gain_m2 <= best->fit.gain_m2) continue;
    const double bend = left - 2.0 * gain_m2 + right;
    const double offset = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
    best = Peak{static_cast<double>(i) + offset, *fits[i]};
  }
  return best;
}

}  // namespace

std::optional<DescentArrest> find_descent_arrest(std::span<const double> height_m,
                                                 double hz,
                                                 double near_frame) {
  MAREY_ASSERT(hz > 0.0);
  const double step = kStep_s * hz;
  const auto search = [&](double middle, double reach_s, bool moves) {
    const int reach = static_cast<int>(std::lround(reach_s / kStep_s));
    std::vector<std::optional<StepFit>> fits;
    for (int i = -reach; i <= reach; ++i) {
      const double frame = middle + i * step;
      fits.push_back(fit_step(height_m, hz, moves ? frame : middle, frame));
    }
    auto peak = highest_peak(fits);
    if (peak) peak->step -= reach;
    return peak;
  };
  auto peak = search(near_frame, kSearch_s, true);
  if (!peak) return std::nullopt;
  double frame = near_frame + peak->step * step;
  // The spans moved with the step, which shifts the peak. They stay from here on.
  if (const auto refined = search(frame, kRefine_s, false)) {
    frame += refined->step * step;
    peak = refined;
  }
  const StepFit& fit = peak->fit;
  if (fit.change_m_per_s2 < kMinStandardErrors * fit.standard_error_m_per_s2) {
    return std::nullopt;
  }
  return DescentArrest{frame, fit.change_m_per_s2};
}

}  // namespace marey::retarget
