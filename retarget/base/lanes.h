// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

/// Arithmetic written once for one body or for many bodies in parallel.
///
/// F is float or double (one body), or a SIMD batch of either (one body per lane). Code
/// over F never branches on one lane's value: it computes both sides and selects, so that
/// a lane's result does not depend on its neighbours. A branch on any(mask) only skips
/// work that would leave the numbers of all lanes unchanged. Only + - * / and sqrt are
/// used, which IEEE 754 rounds exactly: every width gives the same bits (no fused
/// multiplication: -ffp-contract=off). All of it is inlined, for two reasons: a call
/// costs more than most of these functions do, and a function that exists once in a
/// program must not be compiled with the instruction set of one kernel.
namespace marey::retarget {

/// The type that a comparison of two values of F returns.
template <class F>
struct MaskOf {
  using type = decltype(std::declval<F>() < std::declval<F>());
};
template <class F>
using Mask = typename MaskOf<F>::type;

/// The number type of one lane.
template <class F>
struct ScalarOf {
  using type = typename F::value_type;
};
template <>
struct ScalarOf<float> {
  using type = float;
};
template <>
struct ScalarOf<double> {
  using type = double;
};
template <class F>
using Scalar = typename ScalarOf<F>::type;

// The functions that SIMD batches provide, for plain numbers.
template <class F>
requires std::is_floating_point_v<F>
[[nodiscard, gnu::always_inline]] inline F select(bool mask, F if_true, F if_false) {
  return mask ? if_true : if_false;
}
template <class F>
requires std::is_floating_point_v<F>
[[nodiscard, gnu::always_inline]] inline F sqrt(F x) {
  return std::sqrt(x);
}
template <class F>
requires std::is_floating_point_v<F>
[[nodiscard, gnu::always_inline]] inline F abs(F x) {
  return std::fabs(x);
}
template <class F>
requires std::is_floating_point_v<F>
[[nodiscard, gnu::always_inline]] inline F min(F a, F b) {
  return a < b ? a : b;  // As SIMD does, to the sign of a zero.
}
template <class F>
requires std::is_floating_point_v<F>
[[nodiscard, gnu::always_inline]] inline F max(F a, F b) {
  return a > b ? a : b;
}
[[nodiscard, gnu::always_inline]] inline bool any(bool mask) {
  return mask;
}
[[nodiscard, gnu::always_inline]] inline bool all(bool mask) {
  return mask;
}

/// Returns the same number in every lane.
template <class F>
[[nodiscard, gnu::always_inline]] inline F num(double x) {
  return F(static_cast<Scalar<F>>(x));
}
template <class F>
[[nodiscard, gnu::always_inline]] inline F clamp(F x, F low, F high) {
  return min(max(x, low), high);
}
/// Returns the square root of a number that rounding may have pushed below zero.
template <class F>
[[nodiscard, gnu::always_inline]] inline F safe_sqrt(F x) {
  return sqrt(max(x, num<F>(0)));
}

/// Returns -x with the sign of a zero inverted as well. Some SIMD types compute -x as 0 -
/// x.
template <class F>
[[nodiscard, gnu::always_inline]] inline F negated(const F& x) {
  return num<F>(-0.0) - x;
}

template <class F>
struct Vec3 {
  F x{}, y{}, z{};
};

template <class F>
[[gnu::always_inline]] inline Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
[[gnu::always_inline]] inline Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
[[gnu::always_inline]] inline Vec3<F> operator-(const Vec3<F>& a) {
  return {negated(a.x), negated(a.y), negated(a.z)};
}
template <class F>
[[gnu::always_inline]] inline Vec3<F> operator*(const F& s, const Vec3<F>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class F>
[[gnu::always_inline]] inline void operator+=(Vec3<F>& a, const Vec3<F>& b) {
  a = a + b;
}
template <class F>
[[gnu::always_inline]] inline void operator-=(Vec3<F>& a, const Vec3<F>& b) {
  a = a - b;
}
template <class F>
[[nodiscard, gnu::always_inline]] inline F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> cross(const Vec3<F>& a,
                                                       const Vec3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline F length2(const Vec3<F>& a) {
  return dot(a, a);
}
template <class F>
[[nodiscard, gnu::always_inline]] inline F length(const Vec3<F>& a) {
  return sqrt(dot(a, a));
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> select(const Mask<F>& mask,
                                                        const Vec3<F>& if_true,
                                                        const Vec3<F>& if_false) {
  return {select(mask, if_true.x, if_false.x),
          select(mask, if_true.y, if_false.y),
          select(mask, if_true.z, if_false.z)};
}
/// Returns `a` divided by its length; `otherwise` if it is shorter than `min_length`.
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> unit_or(const Vec3<F>& a,
                                                         const Vec3<F>& otherwise,
                                                         F min_length) {
  const F n = length(a);
  return select(n > min_length, (num<F>(1) / max(n, min_length)) * a, otherwise);
}

/// A rotation. A unit quaternion unless stated otherwise.
template <class F>
struct Quat {
  F w{}, x{}, y{}, z{};
};

template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> identity() {
  return {num<F>(1), num<F>(0), num<F>(0), num<F>(0)};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> conjugate(const Quat<F>& q) {
  return {q.w, negated(q.x), negated(q.y), negated(q.z)};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> vector_part(const Quat<F>& q) {
  return {q.x, q.y, q.z};
}
template <class F>
[[gnu::always_inline]] inline Quat<F> operator*(const Quat<F>& a, const Quat<F>& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
          a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> rotate(const Quat<F>& q,
                                                        const Vec3<F>& v) {
  const Vec3<F> u = vector_part(q);
  const Vec3<F> t = cross(u, v);
  const Vec3<F> twice = t + t;
  return v + q.w * twice + cross(u, twice);
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> select(const Mask<F>& mask,
                                                        const Quat<F>& if_true,
                                                        const Quat<F>& if_false) {
  return {select(mask, if_true.w, if_false.w),
          select(mask, if_true.x, if_false.x),
          select(mask, if_true.y, if_false.y),
          select(mask, if_true.z, if_false.z)};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> normalized(const Quat<F>& q) {
  const F s = num<F>(1) / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

/// Normalizes a quaternion that is off unit length by rounding only: one Newton step.
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> trued(const Quat<F>& q) {
  const F square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  const F s = num<F>(1.5) - num<F>(0.5) * square;
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

/// Returns a unit quaternion about w's direction by Cayley's map: the angle is 2 atan(|w|
/// / 2), |w| to third order, and always below half a turn.
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> rotation_by(const Vec3<F>& w_rad) {
  const F half = num<F>(0.5);
  const Vec3<F> h = half * w_rad;
  const F s = num<F>(1) / sqrt(num<F>(1) + length2(h));
  return {s, s * h.x, s * h.y, s * h.z};
}

/// Returns a unit quaternion about w's direction whose angle is always below a quarter
/// turn.
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> rotation_within(const Vec3<F>& w_rad) {
  const F one = num<F>(1);
  const Vec3<F> h = num<F>(0.5) * w_rad;
  const F square = length2(h);
  const F s = one / sqrt(one + square + square);
  return {s * sqrt(one + square), s * h.x, s * h.y, s * h.z};
}

/// Returns the smallest rotation from one direction to another. The directions may have
/// any length except zero. Nearly opposite directions turn about the unit `spare` axis,
/// which should be perpendicular to `from`.
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> rotation_onto(const Vec3<F>& from,
                                                               const Vec3<F>& to,
                                                               const Vec3<F>& spare) {
  // Half-angle algebra: (|a||b| + a.b, a x b) is the rotation, not yet unit.
  const F product = sqrt(length2(from) * length2(to));
  const F w = product + dot(from, to);
  const Vec3<F> axis = cross(from, to);
  const F norm2 = w * w + length2(axis);
  const Mask<F> opposite = norm2 <= num<F>(1e-9) * product * product;
  const F s = num<F>(1) / sqrt(select(opposite, num<F>(1), norm2));
  return select(opposite,
                Quat<F>{num<F>(0), spare.x, spare.y, spare.z},
                Quat<F>{s * w, s * axis.x, s * axis.y, s * axis.z});
}

/// Returns the rotation at `share` of the shorter way from `a` to `b`; 0 gives `a`.
/// Interpolates along the chord, not along the arc: equally continuous, not at constant
/// angular speed.
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> between(const Quat<F>& a,
                                                         const Quat<F>& b,
                                                         const F& share) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F sign = select(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < zero, -one, one);
  const F u = sign * (one - share);
  return normalized(Quat<F>{u * a.w + share * b.w,
                            u * a.x + share * b.x,
                            u * a.y + share * b.y,
                            u * a.z + share * b.z});
}

/// Returns a plain vector or quaternion, copied into every lane.
template <class F>
[[nodiscard, gnu::always_inline]] inline Vec3<F> lanes(const glm::dvec3& v) {
  return {num<F>(v.x), num<F>(v.y), num<F>(v.z)};
}
template <class F>
[[nodiscard, gnu::always_inline]] inline Quat<F> lanes(const glm::dquat& q) {
  return {num<F>(q.w), num<F>(q.x), num<F>(q.y), num<F>(q.z)};
}

}  // namespace marey::retarget
