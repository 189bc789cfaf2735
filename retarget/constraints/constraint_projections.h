// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/base/lanes.h"

/// Projections of a point to the nearest position that satisfies a constraint (Kulpa
/// 2005, 3.3), one per type, for one body or many in parallel (retarget/base/lanes.h).
/// Positions are in the world, or all in another frame with its axes. Lengths are in one
/// unit: metres, or a body's own (BodyNumbers::unit_m). Boxes are aligned with the axes.
/// Finite input gives finite output.
namespace marey::retarget {

/// Distance below which two points define no direction, in the unit of positions: for
/// bodies of about one unit the resolution of single precision.
inline constexpr double kNoDirection = 1e-6;

/// Returns the position at `distance` from `from`, on the side of `place`: distance
/// constraints of all three kinds. With distance 0 it is `from` to the bit. If `place`
/// coincides with `from`, it is straight above it, along +Y.
template <class F>
[[nodiscard]] inline Vec3<F> at_distance(const Vec3<F>& place,
                                         const Vec3<F>& from,
                                         const F& distance) {
  const Vec3<F> up{num<F>(0), num<F>(1), num<F>(0)};
  return from + distance * unit_or(place - from, up, num<F>(kNoDirection));
}

/// Returns the nearest point in a box: allowed space. `place` itself if it is inside.
/// Precondition: low <= high.
template <class F>
[[nodiscard]] inline Vec3<F> inside(const Vec3<F>& place,
                                    const Vec3<F>& low,
                                    const Vec3<F>& high) {
  return {clamp(place.x, low.x, high.x),
          clamp(place.y, low.y, high.y),
          clamp(place.z, low.z, high.z)};
}

/// Returns the nearest point on the faces of a box if `place` is inside, else `place`:
/// forbidden space. Among equally near faces, x comes before y and y before z; the upper
/// of two faces across one axis is used. Precondition: low <= high.
template <class F>
[[nodiscard]] inline Vec3<F> outside(const Vec3<F>& place,
                                     const Vec3<F>& low,
                                     const Vec3<F>& high) {
  const Vec3<F> down = place - low;
  const Vec3<F> up = high - place;
  const Vec3<F> depth{min(down.x, up.x), min(down.y, up.y), min(down.z, up.z)};
  const F min_depth = min(depth.x, min(depth.y, depth.z));
  const Mask<F> is_inside = min_depth > num<F>(0);
  const Mask<F> by_x = is_inside & (depth.x <= min_depth);
  const Mask<F> by_y = is_inside & (depth.y <= min_depth) & !by_x;
  const Mask<F> by_z = is_inside & !by_x & !by_y;
  return {select(by_x, select(down.x < up.x, low.x, high.x), place.x),
          select(by_y, select(down.y < up.y, low.y, high.y), place.y),
          select(by_z, select(down.z < up.z, low.z, high.z), place.z)};
}

/// Returns the end of a lever that rotates with a segment about its joint: orientation.
/// Two nonparallel levers with their ends on target define the rotation of the segment
/// for any position of its joint (one alone, as in figure 3.12, leaves the rotation about
/// itself free).
template <class F>
[[nodiscard]] inline Vec3<F> lever_end(const Vec3<F>& joint,
                                       const Quat<F>& world_from_t_pose,
                                       const Vec3<F>& lever_in_t_pose) {
  return joint + rotate(world_from_t_pose, lever_in_t_pose);
}

}  // namespace marey::retarget
