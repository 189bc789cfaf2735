// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/inertial_offset.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/blend/lane_math.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

using Lanes = BlendPosture::Rotations;

constexpr double kLn2 = 0.69314718055994530942;
constexpr float kNoOffset = 1e-6F;
// Square of half of 240 degrees, the limit of the polynomials. [rad^2]
constexpr float kMaxSquaredHalf = 4.3865F;
constexpr float kMaxHalf = 2.0944F;

// Places in the offset's values.
constexpr std::size_t kExtensionAt = 0;
constexpr std::size_t kMidXAt = 4;
constexpr std::size_t kMidYAt = 8;
constexpr std::size_t kUpperAt = 12;
constexpr std::size_t kLowerAt = 16;
constexpr std::size_t kHeightAt = 20;
constexpr std::size_t kAbdomenAt = 21;
constexpr std::size_t kTorsoAt = 22;

// Turns rotations by rotation vectors, scaled, in the heading frame.
void turn_lanes(const Lanes& x,
                const Lanes& y,
                const Lanes& z,
                float scale,
                BlendPosture& __restrict posture) {
  const float half = 0.5F * scale;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const float hx = half * x[i];
    const float hy = half * y[i];
    const float hz = half * z[i];
    const float square = hx * hx + hy * hy + hz * hz;
    const LaneMask is_far = lane_mask(square > kMaxSquaredHalf);
    const float limit = lane_select(is_far, kMaxHalf * inverse_root(square), 1.0F);
    const float angle2 = lane_select(is_far, kMaxSquaredHalf, square);
    const float k = limit * sine_over_angle(angle2);
    const LaneQuat turn{k * hx, k * hy, k * hz, cosine_of_root(angle2)};
    const LaneQuat q{posture.x[i], posture.y[i], posture.z[i], posture.w[i]};
    const LaneQuat turned =
        nearly_unit({turn.w * q.x + turn.x * q.w + (turn.y * q.z - turn.z * q.y),
                     turn.w * q.y + turn.y * q.w + (turn.z * q.x - turn.x * q.z),
                     turn.w * q.z + turn.z * q.w + (turn.x * q.y - turn.y * q.x),
                     turn.w * q.w - (turn.x * q.x + turn.y * q.y + turn.z * q.z)});
    posture.x[i] = turned.x;
    posture.y[i] = turned.y;
    posture.z[i] = turned.z;
    posture.w[i] = turned.w;
  }
}

glm::dvec3 vector_at(const Lanes& x, const Lanes& y, const Lanes& z, std::size_t i) {
  return {
      static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
}

glm::dquat posture_rotation(const BlendPosture& p, std::size_t i) {
  return glm::normalize(glm::dquat{static_cast<double>(p.w[i]),
                                   static_cast<double>(p.x[i]),
                                   static_cast<double>(p.y[i]),
                                   static_cast<double>(p.z[i])});
}

struct RotationOffset {
  glm::dvec3 vector{0.0};
  glm::dvec3 rate{0.0};  // Derivative of the vector over time.
};

// Offset from `to` to `from` on the shorter arc. Its rate makes exp(vector) * to turn
// with from's angular velocity: the inverse of the left Jacobian of exp, applied to the
// difference of angular velocities.
RotationOffset rotation_offset(const glm::dquat& from,
                               const glm::dvec3& from_rad_s,
                               const glm::dquat& to,
                               const glm::dvec3& to_rad_s) {
  glm::dquat turn = from * glm::conjugate(to);
  if (turn.w < 0.0) turn = -turn;
  const glm::dvec3 axis_sine{turn.x, turn.y, turn.z};
  const double sine = glm::length(axis_sine);
  const double half_rad = std::atan2(sine, turn.w);
  RotationOffset out;
  out.vector = sine > 1e-12 ? (2.0 * half_rad / sine) * axis_sine : 2.0 * axis_sine;
  const glm::dvec3 difference = from_rad_s - turn * to_rad_s;
  const glm::dvec3 across = glm::cross(out.vector, difference);
  const double factor =
      half_rad > 1e-3 ? (1.0 - half_rad * turn.w / sine) / (4.0 * half_rad * half_rad)
                      : 1.0 / 12.0;
  out.rate = difference - 0.5 * across + factor * glm::cross(out.vector, across);
  return out;
}

// Factors of one step of the critically damped decay.
struct Decay {
  float value_of_value, value_of_rate, rate_of_value, rate_of_rate;
};

Decay decay_of(float step_s, float half_life_s) {
  const double y = 2.0 * kLn2 / static_cast<double>(half_life_s);
  const double t = static_cast<double>(step_s);
  const double e = std::exp(-y * t);
  return {static_cast<float>(e * (1.0 + y * t)),
          static_cast<float>(e * t),
          static_cast<float>(-e * y * y * t),
          static_cast<float>(e * (1.0 - y * t))};
}

// Returns the greatest of the values, and of the distances that their rates would still
// make.
template <std::size_t N>
float decay_values(const Decay& decay,
                   float rate_time_s,
                   float* __restrict value,
                   std::array<float, N>& __restrict rate) {
  float greatest = 0.0F;
  for (std::size_t i = 0; i < N; ++i) {
    const float x = value[i];
    const float v = rate[i];
    value[i] = decay.value_of_value * x + decay.value_of_rate * v;
    rate[i] = decay.rate_of_value * x + decay.rate_of_rate * v;
    greatest = std::max(greatest, std::abs(value[i]));
    greatest = std::max(greatest, std::abs(rate[i]) * rate_time_s);
  }
  return greatest;
}

void limit_fold(BlendPosture& posture) {
  constexpr float kFolded_rad = 1.57079633F;
  for (float& fold_rad : posture.fold_rad) {
    fold_rad = std::clamp(fold_rad, 0.0F, kFolded_rad);
  }
}

template <class Rates, class Operation>
void for_limb_values(Rates& rates, const Operation& operation) {
  operation(rates.fold_rad, &BlendPosture::fold_rad, kExtensionAt, false);
  operation(rates.mid_x, &BlendPosture::mid_x, kMidXAt, false);
  operation(rates.mid_y, &BlendPosture::mid_y, kMidYAt, false);
  operation(rates.upper_twist, &BlendPosture::upper_twist_rad, kUpperAt, true);
  operation(rates.lower_twist, &BlendPosture::lower_twist_rad, kLowerAt, true);
}

}  // namespace

PostureRates rates_between(const BlendPosture& before,
                           const BlendPosture& now,
                           float step_s) {
  MAREY_ASSERT(step_s > 0.0F);
  const float per_s = 1.0F / step_s;
  PostureRates rates;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat a{before.x[i], before.y[i], before.z[i], before.w[i]};
    const LaneQuat b{now.x[i], now.y[i], now.z[i], now.w[i]};
    const float dot = lane_dot(a, b);
    const float sign = std::copysign(1.0F, dot);
    const float angle2 = squared_angle(1.0F - sign * dot);
    const float k = 2.0F * sign * per_s / sine_over_angle(angle2);
    // Now, times the conjugate of before.
    rates.x[i] = k * (b.x * a.w - b.w * a.x - (b.y * a.z - b.z * a.y));
    rates.y[i] = k * (b.y * a.w - b.w * a.y - (b.z * a.x - b.x * a.z));
    rates.z[i] = k * (b.z * a.w - b.w * a.z - (b.x * a.y - b.y * a.x));
  }
  for_limb_values(rates,
                  [&](auto& rate, auto BlendPosture::*value, std::size_t, bool is_angle) {
                    for (std::size_t i = 0; i < 4; ++i) {
                      const float change = (now.*value)[i] - (before.*value)[i];
                      rate[i] = per_s * (is_angle ? wrapped_rad(change) : change);
                    }
                  });
  rates.height = per_s * (now.height_legs - before.height_legs);
  return rates;
}

void move_posture(const PostureRates& rates, float time_s, BlendPosture& posture) {
  turn_lanes(rates.x, rates.y, rates.z, time_s, posture);
  for_limb_values(rates,
                  [&](const auto& rate, auto BlendPosture::*value, std::size_t, bool) {
                    for (std::size_t i = 0; i < 4; ++i)
                      (posture.*value)[i] += time_s * rate[i];
                  });
  posture.height_legs += time_s * rates.height;
}

void InertialOffset::start(const BlendPosture& from,
                           const PostureRates& from_rates,
                           const BlendPosture& to,
                           const PostureRates& to_rates) {
  is_active_ = true;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const RotationOffset offset =
        rotation_offset(posture_rotation(from, i),
                        vector_at(from_rates.x, from_rates.y, from_rates.z, i),
                        posture_rotation(to, i),
                        vector_at(to_rates.x, to_rates.y, to_rates.z, i));
    x_[i] = static_cast<float>(offset.vector.x);
    y_[i] = static_cast<float>(offset.vector.y);
    z_[i] = static_cast<float>(offset.vector.z);
    rates_.x[i] = static_cast<float>(offset.rate.x);
    rates_.y[i] = static_cast<float>(offset.rate.y);
    rates_.z[i] = static_cast<float>(offset.rate.z);
  }
  const auto subtract = [](const auto& a, const auto& b, auto& out) {
    for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] - b[i];
  };
  subtract(from_rates.fold_rad, to_rates.fold_rad, rates_.fold_rad);
  subtract(from_rates.mid_x, to_rates.mid_x, rates_.mid_x);
  subtract(from_rates.mid_y, to_rates.mid_y, rates_.mid_y);
  subtract(from_rates.upper_twist, to_rates.upper_twist, rates_.upper_twist);
  subtract(from_rates.lower_twist, to_rates.lower_twist, rates_.lower_twist);
  rates_.height = from_rates.height - to_rates.height;
  for_limb_values(rates_,
                  [&](auto&, auto BlendPosture::*value, std::size_t at, bool is_angle) {
                    for (std::size_t i = 0; i < 4; ++i) {
                      const float change = (from.*value)[i] - (to.*value)[i];
                      values_[at + i] = is_angle ? wrapped_rad(change) : change;
                    }
                  });
  values_[kHeightAt] = from.height_legs - to.height_legs;
  values_[kAbdomenAt] = from.abdomen_share - to.abdomen_share;
  values_[kTorsoAt] = from.torso_share - to.torso_share;
}

void InertialOffset::step(float step_s, float half_life_s, BlendPosture& posture) {
  MAREY_ASSERT(step_s >= 0.0F && half_life_s > 0.0F);
  if (!is_active_) return;
  const Decay decay = decay_of(step_s, half_life_s);
  float greatest = decay_values(decay, half_life_s, x_.data(), rates_.x);
  greatest = std::max(greatest, decay_values(decay, half_life_s, y_.data(), rates_.y));
  greatest = std::max(greatest, decay_values(decay, half_life_s, z_.data(), rates_.z));
  for_limb_values(rates_, [&](auto& rate, auto, std::size_t at, bool) {
    greatest =
        std::max(greatest, decay_values(decay, half_life_s, values_.data() + at, rate));
  });
  std::array<float, 1> height_rate{rates_.height};
  greatest =
      std::max(greatest,
               decay_values(decay, half_life_s, values_.data() + kHeightAt, height_rate));
  rates_.height = height_rate[0];
  // The shares of the spine have no rates: a plain exponential decay.
  const float left = std::exp2(-step_s / half_life_s);
  for (const std::size_t at : {kAbdomenAt, kTorsoAt}) {
    values_[at] *= left;
    greatest = std::max(greatest, std::abs(values_[at]));
  }
  if (greatest < kNoOffset) {
    is_active_ = false;
    return;
  }
  turn_lanes(x_, y_, z_, 1.0F, posture);
  for_limb_values(rates_, [&](auto&, auto BlendPosture::*value, std::size_t at, bool) {
    for (std::size_t i = 0; i < 4; ++i) (posture.*value)[i] += values_[at + i];
  });
  limit_fold(posture);
  posture.height_legs += values_[kHeightAt];
  posture.abdomen_share += values_[kAbdomenAt];
  posture.torso_share += values_[kTorsoAt];
}

void extrapolate(float step_s,
                 float half_life_s,
                 PostureRates& rates,
                 BlendPosture& posture) {
  MAREY_ASSERT(step_s >= 0.0F && half_life_s > 0.0F);
  const double decay_per_s = kLn2 / static_cast<double>(half_life_s);
  const double lost = -std::expm1(-decay_per_s * static_cast<double>(step_s));
  move_posture(rates, static_cast<float>(lost / decay_per_s), posture);
  limit_fold(posture);
  const auto left = static_cast<float>(1.0 - lost);
  for (auto* lanes : {&rates.x, &rates.y, &rates.z}) {
    for (float& rate : *lanes) rate *= left;
  }
  for_limb_values(rates, [&](auto& rate, auto, std::size_t, bool) {
    for (float& value : rate) value *= left;
  });
  rates.height *= left;
}

}  // namespace marey::engine
