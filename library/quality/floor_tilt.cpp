// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/floor_tilt.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/degrees.h"

namespace marey::library {
namespace {

constexpr double kHeightError_m = 0.0006;
constexpr double kSlow_legs_s = 0.3;
constexpr double kMinSlow_s = 1.0 / 30.0;
constexpr double kSamePlace_m = 0.03;
constexpr double kStepError = 0.5;
constexpr double kSideError_m = 0.0001;
constexpr double kSideErrors = 0.5;
constexpr double kSideScatter = 1.0;
// Slopes are rarely larger. It keeps a direction without support at 0.
constexpr double kPriorSlope = 0.05;
constexpr double kSureErrors = 2.75;
constexpr double kOutlier = 3.0;
constexpr int kIterations = 8;
constexpr std::size_t kMinPlaces = 4;
// Fewer places say nothing of their own errors.
constexpr double kManyPlaces = 8.0;
// Forward of the ankles by this angle, the centre of mass of a standing body is in the
// mean of captured styles.
constexpr double kUpright_rad = 5.0 * kRadiansPerDegree;

/// Place of a heel or a ball at rest.
struct StillPlace {
  int side = 0;  ///< 0 left, 1 right.
  bool is_ball = false;
  glm::dvec3 mean{0.0};
  double moved_m = 0.0;  ///< Error by its movement.
  double count = 0.0;    ///< Steps.

  [[nodiscard]] double error_m() const { return std::hypot(kHeightError_m, moved_m); }
};

// Adds a place, or joins it to the last one of the same part if that is near: movements
// of one stance are not independent.
void add(const StillPlace& place, bool is_new, std::vector<StillPlace>& out) {
  if (is_new || glm::distance(out.back().mean, place.mean) > kSamePlace_m) {
    out.push_back(place);
    return;
  }
  StillPlace& last = out.back();
  const double share = place.count / (last.count + place.count);
  last.mean = glm::mix(last.mean, place.mean, share);
  last.moved_m += share * (place.moved_m - last.moved_m);
  last.count += place.count;
}

// Places of heels and balls at rest, at any height: on a tilted floor the heights of
// contacts differ by more than a detector of contacts accepts. They are runs of slow
// steps; in a run at 30 Hz, such a run may have one step.
std::vector<StillPlace> still_places(const QualityFrames& frames) {
  std::vector<StillPlace> out;
  const double max_step_m = kSlow_legs_s * frames.leg_m / frames.hz;
  const double min_steps = std::max(1.0, std::round(kMinSlow_s * frames.hz));
  int last_part = -1;
  for (int part = 0; part < 4; ++part) {
    const std::vector<glm::dvec3>& path =
        part % 2 == 0 ? frames[foot_of(part / 2)].p_in_world
                      : frames.ball_in_world[static_cast<std::size_t>(part) / 2];
    for (std::size_t t = 1; t < path.size(); ++t) {
      StillPlace place{part / 2, part % 2 == 1};
      double count = 0.0;
      double way_m = 0.0;
      for (; t < path.size(); ++t) {
        const double step_m = glm::distance(path[t], path[t - 1]);
        if (step_m >= max_step_m) break;
        place.mean += 0.5 * (path[t] + path[t - 1]);
        way_m += step_m;
        count += 1.0;
      }
      if (count < min_steps) continue;
      place.mean /= count;
      place.moved_m = kStepError * way_m / count * min_steps;
      place.count = count;
      add(place, part != last_part, out);
      last_part = part;
    }
  }
  return out;
}

// Heights of heels and of balls at the origin, half of the height of the left foot over
// the right one, slopes along X and Z.
constexpr std::size_t kTerms = 5;
using Terms = std::array<double, kTerms>;

/// Plane through places, fitted by least squares.
struct Plane {
  Terms terms{};
  std::array<Terms, kTerms> covariance{};

  [[nodiscard]] double off_m(const StillPlace& place, const glm::dvec3& origin) const;
};

Terms row_of(const StillPlace& place, const glm::dvec3& origin) {
  const glm::dvec3 d = place.mean - origin;
  return {place.is_ball ? 0.0 : 1.0,
          place.is_ball ? 1.0 : 0.0,
          place.side == 0 ? 1.0 : -1.0,
          d.x,
          d.z};
}

double Plane::off_m(const StillPlace& place, const glm::dvec3& origin) const {
  const Terms row = row_of(place, origin);
  double height_m = 0.0;
  for (std::size_t k = 0; k < kTerms; ++k) height_m += terms[k] * row[k];
  return place.mean.y - origin.y - height_m;
}

// Inverse of a positive definite matrix, by elimination.
std::array<Terms, kTerms> inverse_of(std::array<Terms, kTerms> m) {
  std::array<Terms, kTerms> out{};
  for (std::size_t k = 0; k < kTerms; ++k) out[k][k] = 1.0;
  for (std::size_t k = 0; k < kTerms; ++k) {
    const double pivot = m[k][k];
    for (std::size_t c = 0; c < kTerms; ++c) {
      m[k][c] /= pivot;
      out[k][c] /= pivot;
    }
    for (std::size_t r = 0; r < kTerms; ++r) {
      if (r == k) continue;
      const double share = m[r][k];
      for (std::size_t c = 0; c < kTerms; ++c) {
        m[r][c] -= share * m[k][c];
        out[r][c] -= share * out[k][c];
      }
    }
  }
  return out;
}

// `side_error_m` is the expected difference between the feet.
Plane fit_plane(const std::vector<StillPlace>& places,
                const std::vector<double>& weights,
                const glm::dvec3& origin,
                double side_error_m) {
  std::array<Terms, kTerms> normal{};
  Terms right{};
  // A part without places has any height.
  normal[0][0] = normal[1][1] = 1e-6;
  normal[2][2] = 1.0 / (side_error_m * side_error_m);
  normal[3][3] = normal[4][4] = 1.0 / (kPriorSlope * kPriorSlope);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Terms row = row_of(places[k], origin);
    for (std::size_t r = 0; r < kTerms; ++r) {
      right[r] += weights[k] * row[r] * (places[k].mean.y - origin.y);
      for (std::size_t c = 0; c < kTerms; ++c) {
        normal[r][c] += weights[k] * row[r] * row[c];
      }
    }
  }
  Plane out;
  out.covariance = inverse_of(normal);
  for (std::size_t r = 0; r < kTerms; ++r) {
    for (std::size_t c = 0; c < kTerms; ++c) {
      out.terms[r] += out.covariance[r][c] * right[c];
    }
  }
  return out;
}

// Angle of the plane through the places, less three standard errors. Raised feet at rest
// are outliers: weights go down with the distance (Huber).
double slope_of_places_rad(const std::vector<StillPlace>& places) {
  if (places.size() < kMinPlaces) return 0.0;
  glm::dvec3 origin(0.0);
  for (const StillPlace& place : places) origin += place.mean;
  origin /= static_cast<double>(places.size());
  const auto count = static_cast<double>(places.size());
  std::vector<double> weights;
  double side_error_m = kSideError_m;
  for (const StillPlace& place : places) {
    weights.push_back(1.0 / (place.error_m() * place.error_m()));
    side_error_m += kSideErrors * place.moved_m / count;
  }
  std::vector<double> errors(places.size());
  Plane plane = fit_plane(places, weights, origin, side_error_m);
  for (int round = 0; round < kIterations; ++round) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      errors[k] = std::abs(plane.off_m(places[k], origin)) / places[k].error_m();
    }
    std::vector<double> scratch = errors;
    const double scale = count < kManyPlaces
                             ? 1.0
                             : std::max(1.0,
                                        1.4826 * quantile_in_place(scratch, 0.5) *
                                            std::sqrt(count / (count - kTerms)));
    // Feet whose own heights differ from step to step also differ from each other.
    const double scattered_m = kSideScatter * (scale - 1.0) * kHeightError_m;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double ratio = errors[k] / (kOutlier * scale);
      const double error_m = scale * places[k].error_m() * std::max(1.0, ratio);
      weights[k] = 1.0 / (error_m * error_m);
    }
    plane = fit_plane(places, weights, origin, side_error_m + scattered_m);
  }
  const glm::dvec2 slope(plane.terms[3], plane.terms[4]);
  const double xx = plane.covariance[3][3];
  const double zz = plane.covariance[4][4];
  const double xz = plane.covariance[3][4];
  const double squared =
      (zz * slope.x * slope.x - 2.0 * xz * slope.x * slope.y + xx * slope.y * slope.y) /
      (xx * zz - xz * xz);
  const double sure = std::sqrt(std::max(0.0, squared));
  if (sure <= kSureErrors) return 0.0;
  return std::atan(glm::length(slope)) * (1.0 - kSureErrors / sure);
}

// Lean of a standing body, forward or backward: that of its soles or that of its centre
// of mass over the ankles, the smaller one if both lean the same way, since either alone
// has other causes (shoes, styles). 0 if it does not stand on both feet half of the time.
double lean_rad(const QualityFrames& frames, const std::vector<FootParts>& contacts) {
  double sole = 0.0;
  double body = 0.0;
  double count = 0.0;
  std::array<const BonePath*, 2> feet{&frames[foot_of(0)], &frames[foot_of(1)]};
  for (std::size_t t = 0; t < contacts.size(); ++t) {
    if (contacts[t] != FootParts{1, 1, 1, 1}) continue;
    glm::dvec3 ankles(0.0);
    glm::dvec3 front(0.0);
    glm::dvec3 up(0.0);
    for (std::size_t s = 0; s < 2; ++s) {
      const glm::dvec3& ankle = feet[s]->p_in_world[t];
      ankles += 0.5 * ankle;
      front += frames.ball_in_world[s][t] - ankle;
      up += feet[s]->world_from_t_pose[t] * glm::dvec3(0.0, 0.5, 0.0);
    }
    front.y = 0.0;
    const glm::dvec3 com = frames.com_in_world[t] - ankles;
    if (glm::length(front) <= 0.0 || com.y <= 0.0) continue;
    front = glm::normalize(front);
    sole += std::asin(glm::dot(up, front));
    body += std::atan2(glm::dot(com, front), com.y) - kUpright_rad;
    count += 1.0;
  }
  if (count < 1.0 || 2.0 * count < frames.count || sole * body <= 0.0) return 0.0;
  return std::min(std::abs(sole), std::abs(body)) / count;
}

}  // namespace

FoundFigure measure_tilt(const QualityFrames& frames,
                         const std::vector<FootParts>& contacts,
                         const QualityLimits& limits) {
  FoundFigure out{"tilt_deg"};
  // In a standing body, the plane shows the slope across, and the lean that along.
  out.value = kDegreesPerRadian * std::hypot(slope_of_places_rad(still_places(frames)),
                                             lean_rad(frames, contacts));
  if (out.value > limits["tilt_deg"].warn) {
    out.frames = FrameRange{0, std::max(0, frames.count - 1)};
    out.places.push_back({*out.frames, std::nullopt, out.value});
  }
  return out;
}

}  // namespace marey::library
