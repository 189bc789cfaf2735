// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/fit_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

constexpr int kRounds = 12;
// Frames at the times themselves are within, in spite of rounding.
constexpr double kRounding_frames = 1e-6;

/// Frames within the times, as positions and times relative to the middle of the flight.
struct FlightFrames {
  std::vector<double> time_s;
  std::vector<glm::dvec3> p_m;
  double middle_s = 0.0;
  glm::dvec3 origin_in_world{0.0};
};

FlightFrames frames_within(std::span<const glm::dvec3> com_in_world,
                           FrameRate rate,
                           const FlightTimes& times) {
  MAREY_ASSERT(rate.hz > 0.0);
  FlightFrames out;
  out.middle_s = 0.5 * (times.takeoff_s + times.landing_s);
  const auto count = static_cast<double>(com_in_world.size());
  const double from =
      std::max(0.0, std::ceil(times.takeoff_s * rate.hz - kRounding_frames));
  const double to =
      std::min(count - 1.0, std::floor(times.landing_s * rate.hz + kRounding_frames));
  if (!(to >= from)) return out;
  const auto first = static_cast<std::size_t>(from);
  const auto last = static_cast<std::size_t>(to);
  out.origin_in_world = com_in_world[(first + last) / 2];
  for (std::size_t i = first; i <= last; ++i) {
    out.time_s.push_back(static_cast<double>(i) / rate.hz - out.middle_s);
    out.p_m.push_back(com_in_world[i] - out.origin_in_world);
  }
  return out;
}

// Weighted least squares of a polynomial with `terms` coefficients (2 or 3) for vectors,
// through the normal equations of times that are centred and scaled to [-1, 1].
std::array<glm::dvec3, 3> polynomial(const FlightFrames& frames,
                                     const std::vector<double>& weights,
                                     std::size_t terms,
                                     double scale_s) {
  std::array<std::array<double, 3>, 3> a{};
  std::array<glm::dvec3, 3> b{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
  for (std::size_t i = 0; i < frames.p_m.size(); ++i) {
    const double t = frames.time_s[i] / scale_s;
    const std::array<double, 3> row{1.0, t, t * t};
    for (std::size_t j = 0; j < terms; ++j) {
      for (std::size_t k = 0; k < terms; ++k) a[j][k] += weights[i] * row[j] * row[k];
      b[j] += weights[i] * row[j] * frames.p_m[i];
    }
  }
  // Gaussian elimination; the matrix is positive definite.
  for (std::size_t j = 0; j < terms; ++j) {
    for (std::size_t i = j + 1; i < terms; ++i) {
      const double share = a[i][j] / a[j][j];
      for (std::size_t k = j; k < terms; ++k) a[i][k] -= share * a[j][k];
      b[i] -= share * b[j];
    }
  }
  std::array<glm::dvec3, 3> x{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
  for (std::size_t j = terms; j-- > 0;) {
    glm::dvec3 rest = b[j];
    for (std::size_t k = j + 1; k < terms; ++k) rest -= a[j][k] * x[k];
    x[j] = rest / a[j][j];
  }
  return x;
}

glm::dvec3 value_at(const std::array<glm::dvec3, 3>& x, double t) {
  return x[0] + t * (x[1] + t * x[2]);
}

// Iteratively reweighted: Huber's weights by the distance of each frame.
std::array<glm::dvec3, 3> robust_polynomial(const FlightFrames& frames,
                                            std::size_t terms,
                                            double scale_s,
                                            double outlier_m) {
  std::vector<double> weights(frames.p_m.size(), 1.0);
  std::array<glm::dvec3, 3> x = polynomial(frames, weights, terms, scale_s);
  for (int round = 0; round < kRounds; ++round) {
    double max_change = 0.0;
    for (std::size_t i = 0; i < frames.p_m.size(); ++i) {
      const double away_m =
          glm::distance(frames.p_m[i], value_at(x, frames.time_s[i] / scale_s));
      const double weight = away_m > outlier_m ? outlier_m / away_m : 1.0;
      max_change = std::max(max_change, std::abs(weight - weights[i]));
      weights[i] = weight;
    }
    if (max_change < 1e-9) break;
    x = polynomial(frames, weights, terms, scale_s);
  }
  return x;
}

}  // namespace

std::optional<FlightFit> fit_flight(std::span<const glm::dvec3> com_in_world,
                                    FrameRate rate,
                                    const FlightTimes& times,
                                    double gravity_m_s2,
                                    double outlier_m) {
  MAREY_ASSERT(outlier_m > 0.0 && std::isfinite(gravity_m_s2));
  FlightFrames frames = frames_within(com_in_world, rate, times);
  if (frames.p_m.size() < 2) return std::nullopt;
  for (std::size_t i = 0; i < frames.p_m.size(); ++i) {
    frames.p_m[i].y += 0.5 * gravity_m_s2 * frames.time_s[i] * frames.time_s[i];
  }
  const double scale_s = 0.5 * (times.landing_s - times.takeoff_s);
  const auto x = robust_polynomial(frames, 2, scale_s, outlier_m);
  FlightFit fit;
  fit.takeoff_s = times.takeoff_s;
  fit.gravity_m_s2 = gravity_m_s2;
  fit.frames = static_cast<int>(frames.p_m.size());
  fit.p_in_world = frames.origin_in_world + x[0] - x[1] -
                   glm::dvec3(0.0, 0.5 * gravity_m_s2 * scale_s * scale_s, 0.0);
  fit.velocity_m_s = x[1] / scale_s + glm::dvec3(0.0, gravity_m_s2 * scale_s, 0.0);
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < frames.p_m.size(); ++i) {
    const glm::dvec3 off = frames.p_m[i] - value_at(x, frames.time_s[i] / scale_s);
    sum_m2 += glm::dot(off, off);
  }
  fit.rms_m = std::sqrt(sum_m2 / static_cast<double>(frames.p_m.size()));
  return fit;
}

std::optional<double> fit_fall_m_s2(std::span<const glm::dvec3> com_in_world,
                                    FrameRate rate,
                                    const FlightTimes& times,
                                    double outlier_m) {
  MAREY_ASSERT(outlier_m > 0.0);
  FlightFrames frames = frames_within(com_in_world, rate, times);
  if (frames.p_m.size() < 4) return std::nullopt;
  // The horizontal axes would only dilute the weights.
  for (glm::dvec3& p : frames.p_m) p = {0.0, p.y, 0.0};
  const double scale_s = 0.5 * (times.landing_s - times.takeoff_s);
  const auto x = robust_polynomial(frames, 3, scale_s, outlier_m);
  return 2.0 * x[2].y / (scale_s * scale_s);
}

}  // namespace marey::dynamics
