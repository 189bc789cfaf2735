// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/ball_flight.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace marey::engine {
namespace {

constexpr double kBallStep_s = 1e-3;
constexpr double kSoonest_s = 1e-9;
constexpr double kMeets_m = 1e-5;

glm::dvec3 ball_acceleration(const glm::dvec3& velocity, const BallOptions& options) {
  return glm::dvec3(0.0, -options.gravity_m_s2, 0.0) -
         options.drag_1_m * glm::length(velocity) * velocity;
}

// One step of the Runge-Kutta method of fourth order.
BallState next_ball(const BallState& b, double step_s, const BallOptions& options) {
  const double half_s = 0.5 * step_s;
  const glm::dvec3 a1 = ball_acceleration(b.velocity_m_s, options);
  const glm::dvec3 v2 = b.velocity_m_s + half_s * a1;
  const glm::dvec3 a2 = ball_acceleration(v2, options);
  const glm::dvec3 v3 = b.velocity_m_s + half_s * a2;
  const glm::dvec3 a3 = ball_acceleration(v3, options);
  const glm::dvec3 v4 = b.velocity_m_s + step_s * a3;
  const glm::dvec3 a4 = ball_acceleration(v4, options);
  return {b.time_s + step_s,
          b.p_in_world + step_s / 6.0 * (b.velocity_m_s + 2.0 * v2 + 2.0 * v3 + v4),
          b.velocity_m_s + step_s / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)};
}

BallState free_ball(const glm::dvec3& p,
                    const glm::dvec3& v,
                    double time_s,
                    const BallOptions& options) {
  const glm::dvec3 g(0.0, -options.gravity_m_s2, 0.0);
  return {time_s, p + time_s * v + 0.5 * time_s * time_s * g, v + time_s * g};
}

// Least root above kSoonest_s of a + b t + c t^2.
std::optional<double> first_root(double a, double b, double c) {
  std::optional<double> first;
  const auto take = [&](double t) {
    if (std::isfinite(t) && t > kSoonest_s && (!first || t < *first)) first = t;
  };
  const double inside = b * b - 4.0 * a * c;
  if (inside < 0.0) return first;
  // The sum that does not cancel.
  const double q = -0.5 * (b + std::copysign(std::sqrt(inside), b));
  if (q != 0.0) take(a / q);
  if (c != 0.0) take(q / c);
  return first;
}

struct BallHit {
  double above_m = 0.0;  // For the ball over the point, at the point's distance.
  double time_s = 0.0;
};

// A throw in the vertical plane through the point. One that falls short is far below.
BallHit throw_at(const glm::dvec3& from,
                 const glm::dvec3& point,
                 const glm::dvec3& across,
                 double speed_m_s,
                 double elevation_rad,
                 const BallOptions& options) {
  const glm::dvec3 velocity = speed_m_s * (std::cos(elevation_rad) * across +
                                           glm::dvec3(0.0, std::sin(elevation_rad), 0.0));
  const auto arrival = ball_arrival(from, velocity, {point, across}, options);
  if (!arrival) return {-1e9, 0.0};
  return {arrival->p_in_world.y - point.y, arrival->time_s};
}

std::optional<BallAim> aim_upright(const glm::dvec3& from,
                                   const glm::dvec3& point,
                                   double speed_m_s,
                                   const BallOptions& options,
                                   BallArc arc) {
  // A point above is met first on the way up, one below by the ball thrown down.
  const bool up = point.y > from.y || arc == BallArc::kSteep;
  const glm::dvec3 direction(0.0, up ? 1.0 : -1.0, 0.0);
  const auto arrival = ball_arrival(
      from, speed_m_s * direction, {point, glm::dvec3(0.0, 1.0, 0.0)}, options);
  if (!arrival) return std::nullopt;
  const double elevation = (up ? 0.5 : -0.5) * glm::pi<double>();
  return BallAim{direction, 0.0, elevation, arrival->time_s};
}

// Tangents of both elevations without drag; nullopt: out of range.
std::optional<double> free_elevation(
    double across_m, double up_m, double speed_m_s, double gravity_m_s2, BallArc arc) {
  if (gravity_m_s2 <= 0.0) return std::atan2(up_m, across_m);
  const double v2 = speed_m_s * speed_m_s;
  const double g = gravity_m_s2;
  const double inside = v2 * v2 - g * (g * across_m * across_m + 2.0 * up_m * v2);
  if (inside < 0.0) return std::nullopt;
  const double root = std::sqrt(inside);
  if (arc == BallArc::kSteep) return std::atan2(v2 + root, g * across_m);
  // As (v2 - root) / (g across), without its cancellation.
  return std::atan2((g * across_m * across_m + 2.0 * up_m * v2) / (v2 + root), across_m);
}

}  // namespace

BallState ball_at(const glm::dvec3& p_in_world,
                  const glm::dvec3& velocity_m_s,
                  double time_s,
                  const BallOptions& options) {
  if (options.drag_1_m <= 0.0) {
    return free_ball(p_in_world, velocity_m_s, time_s, options);
  }
  BallState ball{0.0, p_in_world, velocity_m_s};
  const int steps = static_cast<int>(time_s / kBallStep_s);
  for (int i = 0; i < steps; ++i) ball = next_ball(ball, kBallStep_s, options);
  const double rest_s = time_s - steps * kBallStep_s;
  if (rest_s > 0.0) ball = next_ball(ball, rest_s, options);
  ball.time_s = time_s;
  return ball;
}

std::optional<BallState> ball_arrival(const glm::dvec3& p_in_world,
                                      const glm::dvec3& velocity_m_s,
                                      const BallPlane& plane,
                                      const BallOptions& options) {
  const auto side_of = [&](const glm::dvec3& p) {
    return glm::dot(plane.normal, p - plane.p_in_world);
  };
  if (options.drag_1_m <= 0.0) {
    const auto time_s = first_root(side_of(p_in_world),
                                   glm::dot(plane.normal, velocity_m_s),
                                   -0.5 * options.gravity_m_s2 * plane.normal.y);
    if (!time_s || *time_s > options.max_time_s) return std::nullopt;
    return free_ball(p_in_world, velocity_m_s, *time_s, options);
  }
  BallState ball{0.0, p_in_world, velocity_m_s};
  while (ball.time_s < options.max_time_s) {
    const BallState next = next_ball(ball, kBallStep_s, options);
    const double before = side_of(ball.p_in_world);
    const double after = side_of(next.p_in_world);
    if (before != 0.0 && (after == 0.0 || (before < 0.0) != (after < 0.0))) {
      double low_s = 0.0;
      double high_s = kBallStep_s;
      for (int i = 0; i < 50; ++i) {
        const double mid_s = 0.5 * (low_s + high_s);
        const double side = side_of(next_ball(ball, mid_s, options).p_in_world);
        ((side < 0.0) == (before < 0.0) && side != 0.0 ? low_s : high_s) = mid_s;
      }
      return next_ball(ball, high_s, options);
    }
    ball = next;
  }
  return std::nullopt;
}

std::optional<BallAim> aim_ball(const glm::dvec3& from_in_world,
                                const glm::dvec3& point_in_world,
                                double speed_m_s,
                                const BallOptions& options,
                                BallArc arc) {
  const glm::dvec3 way = point_in_world - from_in_world;
  if (!std::isfinite(glm::length(way)) || !std::isfinite(speed_m_s) || speed_m_s <= 0.0) {
    return std::nullopt;
  }
  const double across_m = std::hypot(way.x, way.z);
  if (across_m < 1e-6) {
    return aim_upright(from_in_world, point_in_world, speed_m_s, options, arc);
  }
  const glm::dvec3 across(way.x / across_m, 0.0, way.z / across_m);
  const auto aim_with = [&](double elevation_rad, double time_s) {
    const double flat = std::cos(elevation_rad);
    return BallAim{flat * across + glm::dvec3(0.0, std::sin(elevation_rad), 0.0),
                   std::atan2(way.x, way.z),
                   elevation_rad,
                   time_s};
  };
  const auto flat =
      free_elevation(across_m, way.y, speed_m_s, options.gravity_m_s2, BallArc::kFlat);
  const auto steep =
      free_elevation(across_m, way.y, speed_m_s, options.gravity_m_s2, BallArc::kSteep);
  if (!flat || !steep) return std::nullopt;
  const auto try_at = [&](double elevation_rad) {
    return throw_at(
        from_in_world, point_in_world, across, speed_m_s, elevation_rad, options);
  };
  if (options.drag_1_m <= 0.0) {
    const double elevation = arc == BallArc::kFlat ? *flat : *steep;
    const double time_s = across_m / (speed_m_s * std::cos(elevation));
    if (time_s > options.max_time_s) return std::nullopt;
    return aim_with(elevation, time_s);
  }
  // Drag lowers the ball at the point's distance, so both solutions are between those
  // without it. The height has one maximum there: golden section until it is positive.
  constexpr double kGolden = 0.6180339887498949;
  double low = *flat;
  double high = *steep;
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  BallHit at_left = try_at(left);
  BallHit at_right = try_at(right);
  for (int i = 0; i < 40 && at_left.above_m < 0.0 && at_right.above_m < 0.0; ++i) {
    if (at_left.above_m > at_right.above_m) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = try_at(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = try_at(right);
    }
  }
  if (at_left.above_m < 0.0 && at_right.above_m < 0.0) return std::nullopt;
  double above = at_left.above_m >= 0.0 ? left : right;
  double below = arc == BallArc::kFlat ? *flat : *steep;
  BallHit hit = try_at(above);
  for (int i = 0; i < 60 && std::abs(hit.above_m) > kMeets_m; ++i) {
    const double mid = 0.5 * (above + below);
    hit = try_at(mid);
    (hit.above_m >= 0.0 ? above : below) = mid;
    if (std::abs(hit.above_m) <= kMeets_m) return aim_with(mid, hit.time_s);
  }
  return aim_with(above, hit.time_s);
}

}  // namespace marey::engine
