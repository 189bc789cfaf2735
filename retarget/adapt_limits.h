// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_lanes.h"

namespace marey::retarget {

/// The nearest rotation of joint `j` in its parent that its limits allow: each axis of
/// the turn away from rest on its own, as tangents of quarter angles (modified Rodrigues
/// parameters), so that it needs no trigonometry and is exact about a single axis.
template <class F>
[[nodiscard]] Quat<F> within_limits(const Lanes<F>& s,
                                    std::size_t j,
                                    const Quat<F>& parent_from_joint) {
  const F one = num<F>(1);
  const Quat<F>& t = s.limit_from_joint[j];
  const Quat<F>& rest = s.rest_from_joint[j];
  const Quat<F> turned = t * (conjugate(rest) * parent_from_joint) * conjugate(t);
  const F sign = select(turned.w < num<F>(0), -one, one);
  const F scale = sign / (one + abs(turned.w));
  const Vec3<F> v = scale * vector_part(turned);
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
