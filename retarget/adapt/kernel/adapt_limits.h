// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_lanes.h"

namespace marey::retarget {

/// Returns the rotation of joint `j` from rest, as tangents of quarter angles (modified
/// Rodrigues parameters) about the axes of its limits.
template <class F>
[[nodiscard]] Vec3<F> turn_from_rest(const Lanes<F>& s,
                                     std::size_t j,
                                     const Quat<F>& parent_from_joint) {
  const F one = num<F>(1);
  const Quat<F>& t = s.limit_from_joint[j];
  const Quat<F> turned =
      t * (conjugate(s.rest_from_joint[j]) * parent_from_joint) * conjugate(t);
  const F sign = select(turned.w < num<F>(0), -one, one);
  const F scale = sign / (one + abs(turned.w));
  return scale * vector_part(turned);
}

/// Extends the limits of joints that exceed them in the reference to the reference's
/// rotation, in the lanes of `mask`, so that unconstrained joints keep their captured
/// rotation. Precondition: limits are the body's own, `reference_local` is the given
/// reference.
template <class F>
void widen_limits(const Plan& plan, const Mask<F>& mask, Lanes<F>& s) {
  for (const int joint : plan.limited) {
    const auto j = static_cast<std::size_t>(joint);
    const Vec3<F> v = turn_from_rest(s, j, s.reference_local[j]);
    Vec3<F>& low = s.limit_min[j];
    Vec3<F>& high = s.limit_max[j];
    low = select(mask, Vec3<F>{min(low.x, v.x), min(low.y, v.y), min(low.z, v.z)}, low);
    high =
        select(mask, Vec3<F>{max(high.x, v.x), max(high.y, v.y), max(high.z, v.z)}, high);
  }
}

/// Returns the nearest rotation of joint `j` in its parent within its limits. Each axis
/// of the rotation from rest is clamped separately, as tangents of quarter angles, so
/// that no trigonometry is needed and the result is exact about a single axis.
template <class F>
[[nodiscard]] Quat<F> within_limits(const Lanes<F>& s,
                                    std::size_t j,
                                    const Quat<F>& parent_from_joint) {
  const F one = num<F>(1);
  const Quat<F>& t = s.limit_from_joint[j];
  const Quat<F>& rest = s.rest_from_joint[j];
  const Vec3<F> v = turn_from_rest(s, j, parent_from_joint);
  const Vec3<F>& low = s.limit_min[j];
  const Vec3<F>& high = s.limit_max[j];
  const Vec3<F> kept{
      clamp(v.x, low.x, high.x), clamp(v.y, low.y, high.y), clamp(v.z, low.z, high.z)};
  const F square = length2(kept);
  const F back = one / (one + square);
  const F two = back + back;
  const Quat<F> allowed{(one - square) * back, two * kept.x, two * kept.y, two * kept.z};
  const Mask<F> inside = (kept.x <= v.x) & (v.x <= kept.x) & (kept.y <= v.y) &
                         (v.y <= kept.y) & (kept.z <= v.z) & (v.z <= kept.z);
  return select(inside, parent_from_joint, rest * (conjugate(t) * allowed * t));
}

}  // namespace marey::retarget
