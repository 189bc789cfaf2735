// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_limits.h"
#include "retarget/adapt/kernel/adapt_measure.h"

namespace marey::retarget {

/// Returns 10 x^3 - 15 x^4 + 6 x^5 over 0..1, constant outside
/// (core/base/smooth_step.h).
template <class F>
[[nodiscard]] inline F smooth(const F& share) {
  const F x = clamp(share, num<F>(0), num<F>(1));
  return x * x * x * (num<F>(10) + x * (num<F>(6) * x - num<F>(15)));
}

/// Returns the bending axis of a limb in the reference posture, in the world: unit,
/// perpendicular to the upper bone. For a bent limb it is computed from joint positions;
/// as the limb straightens, it changes to the hinge of the upper bone (see
/// NormalizedLimb), so it is continuous through the straight limb.
template <class F>
[[nodiscard]] Vec3<F> reference_axis(const LimbPlan& limb,
                                     const Lanes<F>& s,
                                     int number) {
  const auto u = static_cast<std::size_t>(limb.upper);
  const auto l = static_cast<std::size_t>(limb.lower);
  const auto e = static_cast<std::size_t>(limb.end);
  const Vec3<F> upper = s.reference_place[l] - s.reference_place[u];
  const Vec3<F> lower = s.reference_place[e] - s.reference_place[l];
  const F upper2 = length2(upper);
  const F lower2 = length2(lower);
  const Vec3<F> hinge =
      rotate(s.reference_rotation[u], s.hinge[static_cast<std::size_t>(number)]);
  const Vec3<F> seen = cross(upper, lower);
  // Sine of the bend: below 0.07 (4 degrees) the plane is undefined, above 0.21 (12
  // degrees) it is used fully.
  const F sine = safe_sqrt(length2(seen) / max(upper2 * lower2, num<F>(1e-12)));
  const F bent = smooth((sine - num<F>(0.07)) * num<F>(1.0 / 0.14));
  const Vec3<F> own =
      unit_or(hinge - (dot(hinge, upper) / max(upper2, num<F>(1e-12))) * upper,
              hinge,
              num<F>(1e-6));
  const Vec3<F> mixed =
      (num<F>(1) - bent) * own + bent * unit_or(seen, own, num<F>(1e-6));
  return unit_or(mixed, own, num<F>(1e-3));
}

/// Computes the bending axes of all limbs from the reference posture.
template <class F>
void set_axes(const Plan& plan, const Mask<F>& mask, Lanes<F>& s) {
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const auto lower = static_cast<std::size_t>(plan.limbs[l].lower);
    const Vec3<F> axis = reference_axis(plan.limbs[l], s, static_cast<int>(l));
    const Vec3<F> in_lower = rotate(conjugate(s.reference_rotation[lower]), axis);
    s.axis_in_lower[l] = select(mask, in_lower, s.axis_in_lower[l]);
  }
}

/// Returns the same axis in the current posture. A limb bends about this axis only, so it
/// is fixed in both of its bones.
template <class F>
[[nodiscard]] inline Vec3<F> limb_axis(const LimbPlan& limb,
                                       const Lanes<F>& s,
                                       int number) {
  return rotate(s.rotation[static_cast<std::size_t>(limb.lower)],
                s.axis_in_lower[static_cast<std::size_t>(number)]);
}

/// Rotations of a limb's bones, in the world.
template <class F>
struct LimbTurn {
  Quat<F> upper;
  Quat<F> lower;
};

/// Motion of a limb's extremity while the limb rotates: it follows the lower bone, or has
/// its own world orientation.
template <class F>
struct Extremity {
  Mask<F> is_set;
  Quat<F> rotation;
};

/// Returns the extremity of a limb: with the first of its active orientations; with that
/// of the reference when all extremities keep their orientation.
template <class F>
[[nodiscard]] Extremity<F> extremity_of(const LimbPlan& limb,
                                        bool keeps_orientation,
                                        const Lanes<F>& s) {
  const auto e = static_cast<std::size_t>(limb.end);
  Extremity<F> out{num<F>(keeps_orientation ? 1 : 0) > num<F>(0.5),
                   s.reference_rotation[e]};
  for (std::size_t n = limb.orientations.size(); n-- > 0;) {
    const LanePoint<F>& p = s.points[static_cast<std::size_t>(limb.orientations[n])];
    const Mask<F> active = p.active > num<F>(0);
    out.is_set = out.is_set | active;
    out.rotation = select(active, p.goal.rotation, out.rotation);
  }
  return out;
}

/// Returns the world `rotation` of joint `j`, clamped to its limits on a parent that is
/// rotated by `parent`.
template <class F>
[[nodiscard]] inline Quat<F> limited(const Plan& plan,
                                     const Lanes<F>& s,
                                     int j,
                                     const Quat<F>& parent,
                                     const Quat<F>& rotation) {
  const auto i = static_cast<std::size_t>(j);
  if (plan.limit_of[i] < 0 || j == 0) return rotation;
  return trued(parent * within_limits(s, i, conjugate(parent) * rotation));
}

/// Applies `turn` to the joints of a limb in the lanes of `mask`, clamped to their limits
/// if `limits`. Other lanes are unchanged to the bit.
template <class F>
void turn_limb(const Plan& plan,
               const LimbPlan& limb,
               const LimbTurn<F>& turn,
               const Mask<F>& mask,
               const Extremity<F>& extremity,
               bool limits,
               Lanes<F>& s) {
  const auto u = static_cast<std::size_t>(limb.upper);
  const auto l = static_cast<std::size_t>(limb.lower);
  const auto e = static_cast<std::size_t>(limb.end);
  // The conjugates below are inverses for unit rotations only.
  Quat<F> upper = trued(turn.upper * s.rotation[u]);
  Quat<F> lower = trued(turn.lower * s.rotation[l]);
  Quat<F> end =
      trued(select(extremity.is_set, extremity.rotation, turn.lower * s.rotation[e]));
  if (plan.has_limits && limits) {
    // A limit on the upper bone also limits everything attached to it. Limits refer to a
    // joint's own parent: bones between two of these three rotate with the one above.
    const auto own_parent = [&](std::size_t joint,
                                std::size_t above,
                                const Quat<F>& turned) {
      const auto p = static_cast<std::size_t>(plan.parent[joint]);
      return p == above ? turned : turned * conjugate(s.rotation[above]) * s.rotation[p];
    };
    const auto p = plan.parent[u] < 0 ? u : static_cast<std::size_t>(plan.parent[u]);
    const Quat<F> kept_upper = limited(plan, s, limb.upper, s.rotation[p], upper);
    const Quat<F> back = kept_upper * conjugate(upper);
    const Quat<F> under_upper = own_parent(l, u, kept_upper);
    const Quat<F> kept_lower = limited(plan, s, limb.lower, under_upper, back * lower);
    const Quat<F> followed = kept_lower * conjugate(lower) * end;
    upper = kept_upper;
    lower = kept_lower;
    end = limited(plan,
                  s,
                  limb.end,
                  own_parent(e, l, lower),
                  select(extremity.is_set, end, followed));
  }
  const Quat<F> end_turn = end * conjugate(s.rotation[e]);
  const auto carry = [&](const std::vector<int>& joints, const Quat<F>& carried) {
    for (const int j : joints) {
      const auto i = static_cast<std::size_t>(j);
      s.rotation[i] = select(mask, carried * s.rotation[i], s.rotation[i]);
      place_joint(plan, s, j);
    }
  };
  const Quat<F> upper_turn = upper * conjugate(s.rotation[u]);
  const Quat<F> lower_turn = lower * conjugate(s.rotation[l]);
  s.rotation[u] = select(mask, upper, s.rotation[u]);
  carry(limb.between_upper, upper_turn);
  s.rotation[l] = select(mask, lower, s.rotation[l]);
  place_joint(plan, s, limb.lower);
  carry(limb.between_lower, lower_turn);
  s.rotation[e] = select(mask, end, s.rotation[e]);
  place_joint(plan, s, limb.end);
  carry(limb.beyond, end_turn);
}

/// Returns the rotation about the unit `axis` that changes the bend of a limb so that
/// `point` is at the distance `wanted` from the limb's root, or as near to it as
/// possible. `to_root`, `to_end` and `to_point` are vectors from the middle joint. Annex
/// B, for any point. There are two solutions; uses the one on the point's own side of
/// straight, unless only the other bends the limb in its natural direction.
template <class F>
[[nodiscard]] Quat<F> bend_to(const Vec3<F>& axis,
                              const Vec3<F>& to_root,
                              const Vec3<F>& to_end,
                              const Vec3<F>& to_point,
                              const F& wanted) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F tiny = num<F>(1e-12);
  const F root_along = dot(to_root, axis);
  const F point_along = dot(to_point, axis);
  const Vec3<F> root = to_root - root_along * axis;
  const Vec3<F> point = to_point - point_along * axis;
  const F a2 = length2(root);
  const F b2 = length2(point);
  const F ab = sqrt(max(a2 * b2, tiny));
  const F c0 = dot(root, point) / ab;
  const F s0 = dot(axis, cross(root, point)) / ab;
  const F apart = root_along - point_along;
  const F c1 = clamp((a2 + b2 + apart * apart - wanted * wanted) / (ab + ab), -one, one);
  const F size = safe_sqrt(one - c1 * c1);
  // The end of the bone trails the point by an angle that does not depend on the bend. A
  // natural bend has it on the far side, seen along the axis, of the line to the root.
  const F end_sine = dot(axis, cross(to_end, point));
  const F end_cosine = dot(to_end, point);
  const F own = select(s0 > zero, size, -size);
  const F natural = end_sine * c1 - end_cosine * own;
  const F other = end_sine * c1 + end_cosine * own;
  const F min_sine = num<F>(-1e-4) * sqrt(max(b2 * length2(to_end), tiny));
  const F s1 = select((natural < min_sine) & (other >= min_sine), -own, own);
  const F c = c1 * c0 + s1 * s0;
  const F sine = s1 * c0 - c1 * s0;
  // Half angle: (1 + cos, sin) normalised; a half turn at most.
  const F w = max(one + c, zero);
  const F n2 = w * w + sine * sine;
  const Mask<F> half_turn = n2 < num<F>(1e-9);
  const F scale = one / sqrt(select(half_turn, one, n2));
  const F v = select(half_turn, one, scale * sine);
  return {select(half_turn, zero, scale * w), v * axis.x, v * axis.y, v * axis.z};
}

/// Moves the point at `place`, which is attached to the limb, to `target`, or as near as
/// the limb reaches: exact in one step, or optimal (annex B). Lanes outside `mask` are
/// unchanged.
///
/// The swing keeps the half-plane for all points on the limb (B.1). For a point of the
/// lower bone the thesis uses the elbow nearest to its previous position (B.3). That has
/// no solution for a target behind or beyond the elbow as seen from the root, and rotates
/// the limb by up to half a turn near such targets.
template <class F>
void close_limb_on(const Plan& plan,
                   int limb_number,
                   const PointPlan& point,
                   const Vec3<F>& place,
                   const Vec3<F>& target,
                   const Mask<F>& mask,
                   const Extremity<F>& extremity,
                   Lanes<F>& s) {
  const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(limb_number)];
  const Vec3<F> root = s.place[static_cast<std::size_t>(limb.upper)];
  const Vec3<F> middle = s.place[static_cast<std::size_t>(limb.lower)];
  const Vec3<F> axis = limb_axis(limb, s, limb_number);
  const Vec3<F> to_target = target - root;
  const F min_length = num<F>(1e-5);
  if (point.place == LimbPlace::kUpper) {
    const Vec3<F> from = place - root;
    const Mask<F> can = mask & (length2(to_target) > min_length * min_length) &
                        (length2(from) > min_length * min_length);
    const Quat<F> swing =
        rotation_onto(select(can, from, axis), select(can, to_target, axis), axis);
    turn_limb(plan, limb, {swing, swing}, can, extremity, true, s);
    return;
  }
  // Supports are always satisfied (thesis 3.1.1.1), regardless of limits.
  const bool limits = point.goal != GoalKind::kSupport;
  const F distance = length(to_target);
  const Quat<F> bend = bend_to(axis,
                               root - middle,
                               s.place[static_cast<std::size_t>(limb.end)] - middle,
                               place - middle,
                               distance);
  const Vec3<F> from = middle + rotate(bend, place - middle) - root;
  const Mask<F> can = (distance > min_length) & (length2(from) > min_length * min_length);
  const Quat<F> swing =
      rotation_onto(select(can, from, axis), select(can, to_target, axis), axis);
  turn_limb(plan, limb, {swing, swing * bend}, mask, extremity, limits, s);
}

/// Closes the second target on a limb whose first is met (thesis 4.2.2.1). The remaining
/// freedom is a spin about the line through the limb's root and the first point.
template <class F>
void spin_limb_on(const Plan& plan,
                  int limb_number,
                  const Vec3<F>& first_place,
                  const Vec3<F>& place,
                  const Vec3<F>& target,
                  const Mask<F>& mask,
                  const Extremity<F>& extremity,
                  Lanes<F>& s) {
  const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(limb_number)];
  const Vec3<F> root = s.place[static_cast<std::size_t>(limb.upper)];
  const Vec3<F> axis =
      unit_or(first_place - root, limb_axis(limb, s, limb_number), num<F>(1e-5));
  const Vec3<F> from = place - root;
  const Vec3<F> to = target - root;
  const Vec3<F> from_off = from - dot(from, axis) * axis;
  const Vec3<F> to_off = to - dot(to, axis) * axis;
  // Near the axis the direction of a point is undefined, so the spin fades out there.
  const F from2 = length2(from_off);
  const F to2 = length2(to_off);
  const F tiny = num<F>(1e-8);
  const F sure = smooth(num<F>(2500) * min(from2, to2));
  const F like = sqrt(from2 / max(to2, tiny));
  const Vec3<F> direction = from_off + sure * (like * to_off - from_off);
  const Mask<F> can = mask & (from2 > tiny) & (length2(direction) > tiny);
  const Vec3<F> x{num<F>(1), num<F>(0), num<F>(0)};
  const Quat<F> spin =
      rotation_onto(select(can, from_off, x), select(can, direction, x), axis);
  turn_limb(plan, limb, {spin, spin}, can, extremity, true, s);
}

}  // namespace marey::retarget
