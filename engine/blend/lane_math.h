// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

/// Functions of rotations in single precision for loops over lanes: no branch, no call,
/// and only operations that IEEE 754 rounds exactly, so that the compiler turns a loop
/// into vector instructions and every width gives the same bits. std::sqrt would keep the
/// loop scalar, because it may set errno. Polynomials are Chebyshev fits; their errors
/// are tested.
namespace marey::engine {

/// Quaternion of one lane.
struct LaneQuat {
  float x, y, z, w;
};

[[nodiscard, gnu::always_inline]] inline float lane_dot(const LaneQuat& a,
                                                        const LaneQuat& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

/// All bits set, or none: a select by a condition would become a branch in some loops.
using LaneMask = std::int32_t;

[[nodiscard, gnu::always_inline]] inline LaneMask lane_mask(bool is_set) {
  return -static_cast<std::int32_t>(is_set);
}

[[nodiscard, gnu::always_inline]] inline float lane_select(LaneMask first,
                                                           float a,
                                                           float b) {
  return std::bit_cast<float>((std::bit_cast<std::int32_t>(a) & first) |
                              (std::bit_cast<std::int32_t>(b) & ~first));
}

/// Returns acos(1 - u)^2 for u in [0, 1], to a relative error of 2e-7.
[[nodiscard, gnu::always_inline]] inline float squared_angle(float u) {
  float p = 0.00499285711F;
  p = p * u - 0.00831092335F;
  p = p * u + 0.013589262F;
  p = p * u + 0.00515394239F;
  p = p * u + 0.0299196374F;
  p = p * u + 0.0887144879F;
  p = p * u + 0.333341777F;
  p = p * u + 1.99999988F;
  return p * u;
}

/// Returns acos(1 - u)^2 for u in [0, 1.5], to a relative error of 6e-7.
[[nodiscard, gnu::always_inline]] inline float wide_squared_angle(float u) {
  float p = 0.0106416326F;
  p = p * u - 0.0646867231F;
  p = p * u + 0.172586173F;
  p = p * u - 0.25587827F;
  p = p * u + 0.233521149F;
  p = p * u - 0.126305223F;
  p = p * u + 0.0545914136F;
  p = p * u + 0.0198823027F;
  p = p * u + 0.089747563F;
  p = p * u + 0.33330065F;
  p = p * u + 2.00000024F;
  return p * u;
}

/// Returns sin(sqrt(z)) / sqrt(z) for z in [0, 4.5], to 1e-7.
[[nodiscard, gnu::always_inline]] inline float sine_over_angle(float z) {
  float p = -2.2969104e-08F;
  p = p * z + 2.74532408e-06F;
  p = p * z - 0.00019838856F;
  p = p * z + 0.00833330769F;
  p = p * z - 0.166666657F;
  return p * z + 1.0F;
}

/// Returns cos(sqrt(z)) for z in [0, 4.5], to 2e-7.
[[nodiscard, gnu::always_inline]] inline float cosine_of_root(float z) {
  float p = 1.91403537e-09F;
  p = p * z - 2.74512786e-07F;
  p = p * z + 2.47983535e-05F;
  p = p * z - 0.0013888838F;
  p = p * z + 0.0416666642F;
  p = p * z - 0.5F;
  return p * z + 1.0F;
}

/// Returns 1 / sqrt(x) for normal x > 0, to a relative error of 3e-7.
[[nodiscard, gnu::always_inline]] inline float inverse_root(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  auto r = std::bit_cast<float>(0x5F375A86 - (bits >> 1));
  const float half = 0.5F * x;
  r *= 1.5F - half * r * r;
  r *= 1.5F - half * r * r;
  return r * (1.5F - half * r * r);
}

/// Returns an angle moved by full turns to within half a turn of 0, for |angle| below
/// 1e6. [rad]
[[nodiscard, gnu::always_inline]] inline float wrapped_rad(float angle_rad) {
  const float turns = angle_rad * 0.159154943F;
  const auto whole = static_cast<float>(
      static_cast<std::int32_t>(turns + (turns < 0.0F ? -0.5F : 0.5F)));
  // 2 pi in two parts, so that the remainder of few turns loses nothing.
  return (angle_rad - whole * 6.28125F) - whole * 0.00193530718F;
}

/// Returns a quaternion near unit length, normalised.
[[nodiscard, gnu::always_inline]] inline LaneQuat nearly_unit(const LaneQuat& q) {
  const float k = 1.5F - 0.5F * lane_dot(q, q);
  return {k * q.x, k * q.y, k * q.z, k * q.w};
}

/// Weights of the ends of an arc of a squared angle at a place on it.
struct SlerpWeights {
  float first, second;
};

[[nodiscard, gnu::always_inline]] inline SlerpWeights slerp_weights(float squared_rad2,
                                                                    float at) {
  const float inverse = 1.0F / sine_over_angle(squared_rad2);
  const float rest = 1.0F - at;
  return {rest * sine_over_angle(rest * rest * squared_rad2) * inverse,
          at * sine_over_angle(at * at * squared_rad2) * inverse};
}

}  // namespace marey::engine
