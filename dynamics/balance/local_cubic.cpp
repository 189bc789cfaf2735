// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/local_cubic.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Fewer samples on a side leave a cubic no residual.
constexpr std::size_t kMinHalf = 2;

// Sums of the even powers of the scaled positions within a window.
struct PowerSums {
  double s0 = 0.0, s2 = 0.0, s4 = 0.0, s6 = 0.0;
};

}  // namespace

LocalCubic::LocalCubic(std::size_t frame_count, FrameRate rate, double window_s)
    : frame_count_(frame_count) {
  MAREY_ASSERT(rate.hz > 0.0 && window_s >= 0.0);
  const auto wanted = static_cast<std::size_t>(std::lround(0.5 * window_s * rate.hz));
  const std::size_t longest = frame_count > 0 ? (frame_count - 1) / 2 : 0;
  half_ = std::min(std::max(wanted, kMinHalf), longest);
  const std::size_t width = 2 * half_ + 1;
  slope_.assign(width * width, 0.0);
  curvature_.assign(width * width, 0.0);
  if (half_ == 0) return;
  const auto half = static_cast<double>(half_);
  const auto scaled = [&](std::size_t i) {
    return (static_cast<double>(i) - half) / half;
  };
  PowerSums sum;
  for (std::size_t i = 0; i < width; ++i) {
    const double v2 = scaled(i) * scaled(i);
    sum.s0 += 1.0;
    sum.s2 += v2;
    sum.s4 += v2 * v2;
    sum.s6 += v2 * v2 * v2;
  }
  const bool is_cubic = half_ >= kMinHalf;
  const double even = sum.s0 * sum.s4 - sum.s2 * sum.s2;
  const double odd = is_cubic ? sum.s2 * sum.s6 - sum.s4 * sum.s4 : 1.0;
  const double per_s = rate.hz / half;
  for (std::size_t at = 0; at < width; ++at) {
    const double t = scaled(at);
    const bool has_cubic = is_cubic && at == half_;
    for (std::size_t i = 0; i < width; ++i) {
      const double v = scaled(i);
      const double c1 = has_cubic ? (sum.s6 * v - sum.s4 * v * v * v) / odd : v / sum.s2;
      const double c2 = (sum.s0 * v * v - sum.s2) / even;
      slope_[at * width + i] = per_s * (c1 + 2.0 * c2 * t);
      curvature_[at * width + i] = per_s * per_s * 2.0 * c2;
    }
  }
}

std::size_t LocalCubic::first(std::size_t frame) const {
  MAREY_ASSERT(frame < frame_count_);
  if (frame < half_) return 0;
  return std::min(frame - half_, frame_count_ - (2 * half_ + 1));
}

std::size_t LocalCubic::row(std::size_t frame) const {
  return (frame - first(frame)) * (2 * half_ + 1);
}

std::span<const double> LocalCubic::slope(std::size_t frame) const {
  return std::span(slope_).subspan(row(frame), 2 * half_ + 1);
}

std::span<const double> LocalCubic::curvature(std::size_t frame) const {
  return std::span(curvature_).subspan(row(frame), 2 * half_ + 1);
}

}  // namespace marey::dynamics
