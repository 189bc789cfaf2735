// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/lanes.h"

/// What each type of constraint asks of its point, as a place to bring it to (Kulpa 2005,
/// 3.3), for one body or many side by side (retarget/lanes.h). Places are the world's, or
/// all of any other frame with its axes, and lengths in any one unit: metres, or a body's
/// own (BodyNumbers::unit_m); boxes are along its axes. Finite in, finite out.
namespace marey::retarget {

/// Closer than this two points have no direction from one to the other, in the unit of
/// places: for bodies of about one unit as small as single precision tells two apart.
inline constexpr double kNoDirection = 1e-6;

/// The place at `distance` from `from`, on the side where `place` is: distance
/// constraints of all three kinds. With distance 0 it is `from` itself, to the bit; when
/// `place` is nowhere but there, it is straight above it, along +Y.
template <class F>
[[nodiscard]] inline Vec3<F> at_distance(const Vec3<F>& place,
                                         const Vec3<F>& from,
                                         const F& distance) {
  const Vec3<F> up{num<F>(0), num<F>(1), num<F>(0)};
  return from + distance * unit_or(place - from, up, num<F>(kNoDirection));
}

/// The nearest place in a box: allowed space. `place` itself when it is there.
/// Precondition: low <= high.
template <class F>
[[nodiscard]] inline Vec3<F> inside(const Vec3<F>& place,
                                    const Vec3<F>& low,
                                    const Vec3<F>& high) {
  return {clamp(place.x, low.x, high.x),
          clamp(place.y, low.y, high.y),
          clamp(place.z, low.z, high.z)};
}

/// The nearest place on a box' faces when `place` is inside, `place` itself when it is
/// not: forbidden space. Of equally near faces one across x comes before one across y,
/// and that before z; of two across one axis the upper.
/// Precondition: low <= high.
template <class F>
[[nodiscard]] inline Vec3<F> outside(const Vec3<F>& place,
                                     const Vec3<F>& low,
                                     const Vec3<F>& high) {
  const Vec3<F> down = place - low;
  const Vec3<F> up = high - place;
  const Vec3<F> depth{min(down.x, up.x), min(down.y, up.y), min(down.z, up.z)};
  const F least = min(depth.x, min(depth.y, depth.z));
  const Mask<F> is_inside = least > num<F>(0);
  const Mask<F> by_x = is_inside & (depth.x <= least);
  const Mask<F> by_y = is_inside & (depth.y <= least) & !by_x;
  const Mask<F> by_z = is_inside & !by_x & !by_y;
  return {select(by_x, select(down.x < up.x, low.x, high.x), place.x),
          select(by_y, select(down.y < up.y, low.y, high.y), place.y),
          select(by_z, select(down.z < up.z, low.z, high.z), place.z)};
}

/// The end of a lever that turns with a segment about its joint: orientation. Where two
/// levers that are not parallel have their ends, there the segment is turned as wanted,
/// wherever its joint is (one alone, as in figure 3.12, leaves the turn about itself
/// free).
template <class F>
[[nodiscard]] inline Vec3<F> lever_end(const Vec3<F>& joint,
                                       const Quat<F>& world_from_t_pose,
                                       const Vec3<F>& lever_in_t_pose) {
  return joint + rotate(world_from_t_pose, lever_in_t_pose);
}

}  // namespace marey::retarget
