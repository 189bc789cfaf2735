// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "retarget/adapt/kernel/adapt_ground.h"
#include "retarget/adapt/plan/thesis_plan.h"

/// Kinematic adaptation by groups (Kulpa 2005, chapter 4), over lanes.
namespace marey::retarget {

/// A level that includes every target.
inline constexpr double kAllLevels = 1e6;

/// Returns a rotation as a vector that can be averaged: axis times four tangents of a
/// quarter angle. It equals the angle to third order, is at most 4, and is inverted
/// exactly by rotation_of(), so a single target gets its own rotation.
template <class F>
[[nodiscard]] inline Vec3<F> rotation_vector(const Quat<F>& q) {
  const F four = select(q.w < num<F>(0), num<F>(-4), num<F>(4));
  return (four / (num<F>(1) + abs(q.w))) * vector_part(q);
}
template <class F>
[[nodiscard]] inline Quat<F> rotation_of(const Vec3<F>& v) {
  const F square = num<F>(1.0 / 16) * length2(v);
  const F scale = num<F>(1) / (num<F>(1) + square);
  const F half = num<F>(0.5) * scale;
  return {(num<F>(1) - square) * scale, half * v.x, half * v.y, half * v.z};
}

/// Returns a unit vector perpendicular to `v`, which is not zero.
template <class F>
[[nodiscard]] inline Vec3<F> across(const Vec3<F>& v) {
  const F zero = num<F>(0);
  const Mask<F> upright = abs(v.y) > abs(v.x);
  const Vec3<F> other =
      select(upright, Vec3<F>{num<F>(1), zero, zero}, Vec3<F>{zero, num<F>(1), zero});
  return unit_or(cross(v, other), other, num<F>(1e-9));
}

/// Measures one target in the current posture.
template <class F>
void measure_target(const Plan& plan, int k, Lanes<F>& s) {
  const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
  LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
  const F zero = num<F>(0);
  p.place = place_of(point, p, s);
  p.target = target_of(point, p, s);
  p.error = select(p.active > zero, p.target - p.place, Vec3<F>{zero, zero, zero});
}

/// Rotates `joints` (low to high) by a total of `turn`, in the world, together with all
/// of `below`. Lanes outside `mask` are unchanged. The part of the rotation that a
/// joint's limits prevent is lost.
///
/// The joints share the rotation equally, all about its axis. The back is rounded like a
/// spline between the ends of a section, for any number of vertebrae. To first order a
/// shared rotation acts about the mean position of the joints.
template <class F>
void turn_joints(const Plan& plan,
                 const std::vector<int>& joints,
                 const std::vector<int>& below,
                 const Quat<F>& turn,
                 const Mask<F>& mask,
                 Lanes<F>& s) {
  const F one = num<F>(1);
  const auto n = static_cast<double>(joints.size());
  const F sign = select(turn.w < num<F>(0), -one, one);
  std::size_t next = 0;
  Quat<F> before = identity<F>();
  for (const int j : below) {
    const auto i = static_cast<std::size_t>(j);
    const auto p = static_cast<std::size_t>(plan.parent[i] < 0 ? 0 : plan.parent[i]);
    const bool first = j == below.front();
    Quat<F> moved = first ? identity<F>() : s.turn[p];
    if (!first) {
      s.place[i] =
          select(mask, s.place[p] + rotate(s.rotation[p], s.offset[i]), s.place[i]);
    }
    if (next < joints.size() && joints[next] == j) {
      ++next;
      Quat<F> here = turn;
      if (next < joints.size()) {
        const F b = num<F>(static_cast<double>(next) / n);
        const F a = one - b;
        const F c = sign * b;
        here = normalized(Quat<F>{a + c * turn.w, c * turn.x, c * turn.y, c * turn.z});
      }
      moved = moved * (conjugate(before) * here);
      before = here;
      const Quat<F> was = s.rotation[i];
      Quat<F> now = trued(moved * was);
      if (plan.limit_of[i] >= 0 && j != 0) {
        now = trued(s.rotation[p] * within_limits(s, i, conjugate(s.rotation[p]) * now));
        moved = now * conjugate(was);
      }
      s.turn[i] = moved;
      s.rotation[i] = select(mask, now, was);
      continue;
    }
    s.turn[i] = moved;
    s.rotation[i] = select(mask, trued(moved * s.rotation[i]), s.rotation[i]);
  }
}

/// Returns the point about which a rotation shared by `joints` acts.
template <class F>
[[nodiscard]] Vec3<F> pivot_of(const std::vector<int>& joints, const Lanes<F>& s) {
  Vec3<F> sum = s.place[static_cast<std::size_t>(joints.front())];
  for (std::size_t n = 1; n < joints.size(); ++n) {
    sum += s.place[static_cast<std::size_t>(joints[n])];
  }
  if (joints.size() == 1) return sum;
  return num<F>(1.0 / static_cast<double>(joints.size())) * sum;
}

/// Returns true, per lane, if a limb has an active support.
template <class F>
[[nodiscard]] Mask<F> stands(const ThesisPlan& thesis, int limb, const Lanes<F>& s) {
  Mask<F> out = num<F>(0) > num<F>(1);
  if (limb < 0) return out;
  for (const int k : thesis.supports[static_cast<std::size_t>(limb)]) {
    out = out | (s.points[static_cast<std::size_t>(k)].active > num<F>(0));
  }
  return out;
}

/// Returns the smallest rotation of a segment that satisfies one target alone (4.2.2.1).
template <class F>
[[nodiscard]] Quat<F> turn_towards(const PointPlan& point,
                                   const LanePoint<F>& p,
                                   const Vec3<F>& pivot,
                                   const Lanes<F>& s) {
  if (point.turns_only()) {
    const Quat<F>& now = s.rotation[static_cast<std::size_t>(point.joint)];
    return p.goal.rotation * conjugate(now);
  }
  const F min_length2 = num<F>(1e-10);
  const Vec3<F> from = p.place - pivot;
  const Vec3<F> to = p.target - pivot;
  const Mask<F> can = (length2(from) > min_length2) & (length2(to) > min_length2);
  const Vec3<F> up{num<F>(0), num<F>(1), num<F>(0)};
  return rotation_onto(
      select(can, from, up), select(can, to, up), across(select(can, from, up)));
}

/// Returns the rotation about the unit `axis` through `pivot` that brings `place` as near
/// to `target` as possible.
template <class F>
[[nodiscard]] Quat<F> spin_towards(const Vec3<F>& axis,
                                   const Vec3<F>& pivot,
                                   const Vec3<F>& place,
                                   const Vec3<F>& target) {
  const Vec3<F> from = place - pivot;
  const Vec3<F> to = target - pivot;
  const Vec3<F> from_off = from - dot(from, axis) * axis;
  const Vec3<F> to_off = to - dot(to, axis) * axis;
  const F min_length2 = num<F>(1e-8);
  const Mask<F> can = (length2(from_off) > min_length2) & (length2(to_off) > min_length2);
  const Vec3<F> x = across(axis);
  return rotation_onto(select(can, from_off, x), select(can, to_off, x), axis);
}

/// Rotation of one segment, accumulated over its targets.
template <class F>
struct SegmentTurn {
  Quat<F> turn = identity<F>();
  Mask<F> free;   ///< No target has rotated it.
  Mask<F> spins;  ///< One target is satisfied; the line to its point is an axis.
  Vec3<F> axis;
};

/// Adds the targets of one level (all levels in blend mode) to a segment. The first level
/// gets the mean, by importance, of the rotation of each target alone; the next level
/// gets a spin.
template <class F>
void add_to_segment(const Plan& plan,
                    std::span<const int> points,
                    const Vec3<F>& pivot,
                    const Mask<F>& mask,
                    Lanes<F>& s,
                    SegmentTurn<F>& out) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Vec3<F> sum{zero, zero, zero};
  F weights = zero;
  F count = zero;
  F max_urgency = zero;
  Vec3<F> line{zero, zero, zero};
  Mask<F> spun = zero > one;
  for (const int k : points) {
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
    measure_target(plan, k, s);
    // The thesis prints "<", which is an error. Below its precision a target fades out,
    // to zero at half of it, so that the posture does not jump after a small move of the
    // target.
    const F urgency =
        clamp(num<F>(2) * length(p.error) * p.per_precision - one, zero, one);
    const Mask<F> applies = mask & (p.active > zero) & (urgency > zero);
    if (!any(applies)) continue;
    const Mask<F> turns = applies & out.free;
    if (any(turns)) {
      const Vec3<F> own = rotation_vector(turn_towards(point, p, pivot, s));
      const F weight = select(turns, urgency * p.weight, zero);
      max_urgency = select(turns, max(max_urgency, urgency), max_urgency);
      sum += weight * own;
      weights = weights + weight;
      // An orientation leaves no axis to spin about.
      count = count + select(turns, num<F>(point.turns_only() ? 2 : 1), zero);
      line = select(turns, p.place - pivot, line);
    }
    const Mask<F> then = applies & out.spins & !spun;
    if (any(then) && !point.turns_only()) {
      const Vec3<F> place = pivot + rotate(out.turn, p.place - pivot);
      const Quat<F> spin = spin_towards(out.axis, pivot, place, p.target);
      out.turn = select(then, spin * out.turn, out.turn);
      spun = spun | then;
    }
  }
  const Mask<F> turned = out.free & (count > zero);
  const Quat<F> mean = rotation_of((max_urgency / max(weights, num<F>(1e-9))) * sum);
  out.turn = select(turned, mean, out.turn);
  out.axis =
      select(turned, unit_or(rotate(mean, line), out.axis, num<F>(1e-5)), out.axis);
  out.spins = (out.spins & !spun) | (turned & (count < num<F>(1.5)));
  out.free = out.free & !turned;
}

/// Performs the fraction `share` of one step of cyclic descent for a segment (4.2.2.1,
/// 4.2.2.2).
template <class F>
void adapt_segment(const Plan& plan,
                   const ThesisPlan& thesis,
                   const ThesisTurn& segment,
                   const SolveSettings& settings,
                   const F& share,
                   const Mask<F>& mask,
                   Lanes<F>& s) {
  const F zero = num<F>(0);
  Mask<F> may = mask & !stands(thesis, segment.support_limb, s);
  if (segment.extremity_of >= 0) {
    const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(segment.extremity_of)];
    may = may & !extremity_of(limb, settings.keeps_orientation, s).is_set;
  }
  if (!any(may)) return;
  const Vec3<F> pivot = pivot_of(segment.joints, s);
  SegmentTurn<F> segment_turn{
      identity<F>(), may, zero > num<F>(1), {zero, num<F>(1), zero}};
  const std::span<const int> points = segment.points;
  std::size_t begin = 0;
  while (begin < points.size()) {
    std::size_t end = begin + 1;
    const auto level = [&](std::size_t n) {
      return plan.points[static_cast<std::size_t>(points[n])].level;
    };
    while (end < points.size() && (settings.blend || level(end) == level(begin))) ++end;
    add_to_segment(plan, points.subspan(begin, end - begin), pivot, may, s, segment_turn);
    begin = end;
  }
  const Mask<F> turns = may & !segment_turn.free;
  if (!any(turns)) return;
  Vec3<F> v = rotation_vector(segment_turn.turn);
  if (segment.limb_of_hinge >= 0) {
    const int number = segment.limb_of_hinge;
    const Vec3<F> axis =
        limb_axis(plan.limbs[static_cast<std::size_t>(number)], s, number);
    v = dot(v, axis) * axis;
  }
  turn_joints(plan, segment.joints, segment.below, rotation_of(share * v), turns, s);
}

/// Closes one limb on its targets unless it has a support (4.2.1). Orientation targets of
/// its bones apply when it has no position target.
template <class F>
void adapt_limb(const Plan& plan,
                const ThesisPlan& thesis,
                int number,
                const SolveSettings& settings,
                const Mask<F>& mask,
                Lanes<F>& s) {
  const auto l = static_cast<std::size_t>(number);
  const LimbPlan& limb = plan.limbs[l];
  const std::vector<int>& bones = thesis.bone_orientations[l];
  if (limb.points.empty() && limb.orientations.empty() && bones.empty() &&
      !settings.keeps_orientation) {
    return;
  }
  Mask<F> free = mask & !stands(thesis, number, s);
  if (!any(free)) return;
  Mask<F> placed = num<F>(0) > num<F>(1);
  for (const int k : limb.points) {
    measure_target(plan, k, s);
    placed = placed | (s.points[static_cast<std::size_t>(k)].active > num<F>(0));
  }
  close_limb(plan, number, settings, num<F>(kAllLevels), free, s);
  for (const int k : bones) {
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    measure_target(plan, k, s);
    const LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
    const Mask<F> turns = free & !placed & (p.active > num<F>(0));
    if (!any(turns)) continue;
    const Quat<F> turn = turn_towards(point, p, s.place[0], s);
    turn_limb(plan,
              limb,
              {turn, turn},
              turns,
              extremity_of(limb, settings.keeps_orientation, s),
              true,
              s);
    free = free & !turns;
  }
}

/// Processes the groups in the order of the table: those of limbs and head, or those of
/// the trunk (last before the root).
template <class F>
void adapt_groups(const Plan& plan,
                  const ThesisPlan& thesis,
                  bool trunk,
                  const SolveSettings& settings,
                  const F& share,
                  const Mask<F>& mask,
                  Lanes<F>& s) {
  for (const ThesisGroup& group : thesis.groups) {
    if (group.is_trunk != trunk) continue;
    for (const ThesisStep& step : group.steps) {
      if (step.is_limb) {
        adapt_limb(plan, thesis, step.index, settings, mask, s);
      } else {
        const ThesisTurn& turn = thesis.turns[static_cast<std::size_t>(step.index)];
        adapt_segment(plan, thesis, turn, settings, share, mask, s);
      }
    }
  }
}

/// Returns the root translation for the constraints (equation 4.1): the mean of their
/// errors by importance, those of the pelvis and of the groups together. This equals the
/// mean of the two sets' means weighted by their sums of importances. CmRoot, and the
/// axes that balance leaves free (5.3.2), are part of the lanes' root weights.
template <class F>
[[nodiscard]] Vec3<F> mean_root_error(const Plan& plan,
                                      const ThesisPlan& thesis,
                                      Lanes<F>& s) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Vec3<F> sum{zero, zero, zero};
  F weights = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    if (!thesis.moves_root[k]) continue;
    const LanePoint<F>& p = s.points[k];
    measure_target(plan, static_cast<int>(k), s);
    const F weight =
        select(is_served(plan.points[k], p, num<F>(kAllLevels)), p.weight, zero);
    sum += weight * p.error;
    weights = weights + weight;
  }
  const Vec3<F> mean = (one / max(weights, num<F>(1e-6))) * sum;
  const F floor = (one - s.balance) * s.root_weight_on_floor;
  const F up = (one - s.balance * s.vertical) * s.root_weight;
  return {floor * mean.x, up * mean.y, floor * mean.z};
}

}  // namespace marey::retarget
