// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_lanes.h"
#include "retarget/constraints/constraint_projections.h"

namespace marey::retarget {

/// Computes the position of joint `j` from the position and rotation of its parent.
template <class F>
[[gnu::always_inline]] inline void place_joint(const Plan& plan, Lanes<F>& s, int j) {
  const auto p = static_cast<std::size_t>(plan.parent[static_cast<std::size_t>(j)]);
  const auto i = static_cast<std::size_t>(j);
  s.place[i] = s.place[p] + rotate(s.rotation[p], s.offset[i]);
}

/// Computes the positions of live joints from their rotations and the position of the
/// root.
template <class F>
inline void place_live_joints(const Plan& plan, Lanes<F>& s) {
  for (const int j : plan.live) {
    if (j != 0) place_joint(plan, s, j);
  }
}

/// Returns the remaining rotation as a vector in world axes. Its length is twice the sine
/// of half the angle.
template <class F>
[[nodiscard]] inline Vec3<F> turn_left(const Quat<F>& now, const Quat<F>& wanted) {
  const Quat<F> q = wanted * conjugate(now);
  const F two = select(q.w < num<F>(0), num<F>(-2), num<F>(2));
  return two * vector_part(q);
}

/// Returns the current position of a target's point.
template <class F>
[[nodiscard]] inline Vec3<F> place_of(const PointPlan& point,
                                      const LanePoint<F>& p,
                                      const Lanes<F>& s) {
  const auto j = static_cast<std::size_t>(point.joint);
  return s.place[j] + rotate(s.rotation[j], p.in_joint);
}

/// Returns the position of the other point of a distance within the body.
template <class F>
[[nodiscard]] inline Vec3<F> other_place(const PointPlan& point,
                                         const LanePoint<F>& p,
                                         const Lanes<F>& s) {
  const auto o = static_cast<std::size_t>(point.other_joint);
  return s.place[o] + rotate(s.rotation[o], p.goal.b);
}

/// Returns the target position for a point that is at `p.place` (thesis 3.3: one
/// conversion per type).
template <class F>
[[nodiscard]] inline Vec3<F> target_of(const PointPlan& point,
                                       const LanePoint<F>& p,
                                       const Lanes<F>& s) {
  switch (point.goal) {
    case GoalKind::kSupport:
      break;
    case GoalKind::kDistanceToPoint:
      return point.at_distance ? at_distance(p.place, p.goal.a, p.goal.distance)
                               : p.goal.a;
    case GoalKind::kDistanceToOther:
      return at_distance(p.place, other_place(point, p, s), p.goal.distance);
    case GoalKind::kAllowedSpace:
      return inside(p.place, p.goal.a, p.goal.b);
    case GoalKind::kForbiddenSpace:
      return outside(p.place, p.goal.a, p.goal.b);
    case GoalKind::kOrientation:
      return p.place + turn_left(s.rotation[static_cast<std::size_t>(point.joint)],
                                 p.goal.rotation);
  }
  return p.goal.a;
}

/// Returns the position to hold for a point whose level is done (hold_point() in
/// adapt_levels.h).
template <class F>
[[nodiscard]] inline Vec3<F> held_target(const PointPlan& point,
                                         const LanePoint<F>& p,
                                         const Lanes<F>& s) {
  if (point.turns_only()) return p.target - p.held;
  if (point.goal != GoalKind::kDistanceToOther) return p.held;
  return at_distance(p.place, other_place(point, p, s), p.held.x);
}

/// Measures positions, targets and errors of all targets.
template <class F>
void measure_points(const Plan& plan, Lanes<F>& s, const F& level) {
  const F zero = num<F>(0);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    LanePoint<F>& p = s.points[k];
    p.place = place_of(point, p, s);
    p.target = target_of(point, p, s);
    if (point.level > 0 && any(p.holds > zero)) {
      p.target = select(p.holds > zero, held_target(point, p, s), p.target);
    }
    const Mask<F> requested = (p.active > zero) & (num<F>(point.level) <= level);
    const Vec3<F> none{zero, zero, zero};
    p.error = select(requested, p.target - p.place, none);
  }
}

/// Computes the centre of mass, and for each live joint the mass and moment of everything
/// it carries.
template <class F>
void measure_balance(const Plan& plan, Lanes<F>& s) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.below_mass[i] = s.carried_mass[i];
    s.below_moment[i] =
        s.carried_mass[i] * (s.place[i] + rotate(s.rotation[i], s.carried_in_joint[i]));
  }
  for (std::size_t n = plan.live.size(); n-- > 1;) {
    const auto i = static_cast<std::size_t>(plan.live[n]);
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    s.below_mass[p] = s.below_mass[p] + s.below_mass[i];
    s.below_moment[p] += s.below_moment[i];
  }
  s.com = (num<F>(1) / max(s.below_mass[0], num<F>(1e-9))) * s.below_moment[0];
}

/// Returns the error of the centre of mass; zero without balance, and zero in height
/// unless `vertical`.
template <class F>
[[nodiscard]] inline Vec3<F> balance_error(const Lanes<F>& s) {
  const Vec3<F> e = s.com_target - s.com;
  return {s.balance * e.x, s.balance * s.vertical * e.y, s.balance * e.z};
}

}  // namespace marey::retarget
