// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/motion/joint_rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace marey::reconstruct {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;

/// Wraps into [-pi, pi].
double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * kHalfTurn_rad);
}

double squared(double value) {
  return value * value;
}

/// Returns the other three angles of the same rotation.
std::array<double, 3> other_triple(const std::array<double, 3>& a) {
  return {wrapped(a[0] + kHalfTurn_rad),
          wrapped(kHalfTurn_rad - a[1]),
          wrapped(a[2] + kHalfTurn_rad)};
}

double step_cost(const std::array<double, 3>& from, const std::array<double, 3>& to) {
  double cost = 0.0;
  for (std::size_t i = 0; i < 3; ++i) cost += squared(wrapped(to[i] - from[i]));
  return cost;
}

/// So small that a second far outside costs less than one step of half a turn; it decides
/// only between equal steps.
double range_cost(const std::array<double, 3>& a,
                  const std::array<AngleRange, 3>& usual) {
  constexpr double kWeight = 1e-3;
  double cost = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    cost += squared(std::max({0.0, usual[i].low_rad - a[i], a[i] - usual[i].high_rad}));
  }
  return kWeight * cost;
}

void hold_locked(const std::array<Series, 3>& angles,
                 std::span<const std::uint16_t> locked,
                 unsigned bit) {
  const auto is_locked = [&](std::size_t frame) {
    return (locked[frame] >> bit & 1U) != 0;
  };
  std::size_t known = 0;
  while (known < locked.size() && is_locked(known)) ++known;
  double held_rad = known < locked.size() ? angles[0][known] : 0.0;
  for (std::size_t frame = 0; frame < locked.size(); ++frame) {
    if (!is_locked(frame)) {
      held_rad = angles[0][frame];
      continue;
    }
    const double rest_rad = angles[0][frame] - held_rad;
    angles[0][frame] = held_rad;
    angles[2][frame] = wrapped(angles[1][frame] > 0.0 ? rest_rad : -rest_rad);
  }
}

}  // namespace

Cardan cardan_angles(const glm::dquat& rotation, const std::array<int, 3>& axes) {
  const glm::dmat3 m = glm::mat3_cast(rotation);
  const auto [i, j, k] = axes;
  const auto at = [&](int row, int column) { return m[column][row]; };
  Cardan out;
  const double cosine = std::hypot(at(i, i), at(i, j));
  out.angle_rad[1] = std::atan2(at(i, k), cosine);
  constexpr double kLockedBelow = 1e-6;
  out.locked = cosine < kLockedBelow;
  if (out.locked) {
    out.angle_rad[0] = std::atan2(at(k, j), at(j, j));
    return out;
  }
  out.angle_rad[0] = std::atan2(-at(j, k), at(k, k));
  out.angle_rad[2] = std::atan2(-at(i, j), at(i, i));
  return out;
}

HingeAngles nearest_hinges(const glm::dquat& rotation,
                           const glm::dvec3& first,
                           const glm::dvec3& second) {
  // The cosine of half the remaining angle is bilinear in the cosines and sines of half
  // the hinges' angles, and therefore a sum of a cosine of their sum and one of their
  // difference.
  const glm::dvec3 v(rotation.x, rotation.y, rotation.z);
  const double cos_cos = rotation.w;
  const double cos_sin = glm::dot(v, second);
  const double sin_cos = glm::dot(v, first);
  const double sin_sin =
      glm::dot(v, glm::cross(first, second)) - rotation.w * glm::dot(first, second);
  const double half_sum = std::atan2(cos_sin + sin_cos, cos_cos - sin_sin);
  const double half_difference = std::atan2(sin_cos - cos_sin, cos_cos + sin_sin);
  return {wrapped(half_sum + half_difference), wrapped(half_sum - half_difference)};
}

double nearest_hinge(const glm::dquat& rotation, const glm::dvec3& axis) {
  const glm::dvec3 v(rotation.x, rotation.y, rotation.z);
  return wrapped(2.0 * std::atan2(glm::dot(v, axis), rotation.w));
}

void unwrap(const Series& angle_rad) {
  for (std::size_t i = 1; i < angle_rad.frames; ++i) {
    const double turns =
        std::round((angle_rad[i - 1] - angle_rad[i]) / (2.0 * kHalfTurn_rad));
    angle_rad[i] += turns * 2.0 * kHalfTurn_rad;
  }
}

void follow_cardan(const std::array<Series, 3>& angles,
                   const std::array<AngleRange, 3>& usual,
                   std::span<const std::uint16_t> locked,
                   unsigned bit,
                   std::vector<std::uint8_t>& way) {
  const std::size_t frames = locked.size();
  if (frames == 0) return;
  hold_locked(angles, locked, bit);
  // Two triples per frame: the least cost to each, and for each of them (one bit) the
  // previous frame's triple.
  const auto triples = [&](std::size_t frame) {
    const std::array<double, 3> one{angles[0][frame], angles[1][frame], angles[2][frame]};
    return std::array{one, other_triple(one)};
  };
  way.assign(frames, 0);
  auto before = triples(0);
  std::array<double, 2> cost{range_cost(before[0], usual), range_cost(before[1], usual)};
  for (std::size_t frame = 1; frame < frames; ++frame) {
    const auto now = triples(frame);
    const double stay = step_cost(before[0], now[0]);
    const double change = step_cost(before[0], now[1]);
    const double stay_other = step_cost(before[1], now[1]);
    const double change_other = step_cost(before[1], now[0]);
    std::array<double, 2> next{};
    const bool from_other = cost[1] + change_other < cost[0] + stay;
    next[0] = from_other ? cost[1] + change_other : cost[0] + stay;
    const bool other_from_other = cost[1] + stay_other < cost[0] + change;
    next[1] = other_from_other ? cost[1] + stay_other : cost[0] + change;
    way[frame] =
        static_cast<std::uint8_t>((from_other ? 1 : 0) | (other_from_other ? 2 : 0));
    cost = {next[0] + range_cost(now[0], usual), next[1] + range_cost(now[1], usual)};
    before = now;
  }
  unsigned triple = cost[1] < cost[0] ? 1U : 0U;
  for (std::size_t frame = frames; frame-- > 0;) {
    if (triple == 1U) {
      const auto other = triples(frame)[1];
      for (std::size_t i = 0; i < 3; ++i) angles[i][frame] = other[i];
    }
    triple = (way[frame] >> triple) & 1U;
  }
  for (const Series& angle : angles) unwrap(angle);
}

}  // namespace marey::reconstruct
