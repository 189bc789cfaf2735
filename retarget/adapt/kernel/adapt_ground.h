// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/close_limbs.h"

/// Ground adaptation (Kulpa 2005, 4.2.4) and muscle limits (4.2.3), over lanes. Both
/// methods start with the complete adaptation; the loop of the thesis calls the fast one
/// after every move of the root. Postures that need no correction are unchanged to the
/// bit.
namespace marey::retarget {

/// Distance, in units, below which a footprint and the foot are taken as coincident: a
/// few rounding errors.
inline constexpr double kOnFootprint = 1e-6;
/// Maximum horizontal distance of the root from above a footprint, as a share of the leg,
/// unless the reference exceeds it. Beyond it the root's height drops increasingly fast.
inline constexpr double kMaxStride = 0.95;
/// Minimum height of the hips above a footprint, as a share of the leg.
inline constexpr double kMinHeight = 0.45;

/// Moves the root and all joints. A zero shift changes nothing.
template <class F>
void shift_root(const Plan& plan, const Vec3<F>& shift, Lanes<F>& s) {
  const F zero = num<F>(0);
  const Mask<F> moves = length2(shift) > zero;
  s.place[0] = select(moves, s.place[0] + shift, s.place[0]);
  place_live_joints(plan, s);
}

/// State of a leg with a support, for fast ground adaptation.
template <class F>
struct Stand {
  Mask<F> active;
  Vec3<F> hip;
  Vec3<F> ankle;  ///< Target of the end of the leg's reach.
  F reach;        ///< Length of the straight leg.
};

template <class F>
[[nodiscard]] Stand<F> stand_of(const LimbPlan& limb,
                                const PointPlan& point,
                                const SolveSettings& settings,
                                const LanePoint<F>& p,
                                const Lanes<F>& s) {
  const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
  const LimbTarget<F> limb_target = limb_target_of(limb, point, p, extremity, s);
  const Vec3<F>& hip = s.place[static_cast<std::size_t>(limb.upper)];
  const Vec3<F>& knee = s.place[static_cast<std::size_t>(limb.lower)];
  return {p.active > num<F>(0),
          hip,
          limb_target.target,
          length(knee - hip) + length(limb_target.place - knee)};
}

/// Calls `visit(limb, stand, point)` for each support on a limb. `point` is its measured
/// LanePoint.
template <class F, class Visit>
void for_each_stand(const Plan& plan,
                    const SolveSettings& settings,
                    Lanes<F>& s,
                    const Visit& visit) {
  for (const LimbPlan& limb : plan.limbs) {
    for (const int k : limb.points) {
      const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
      if (point.goal != GoalKind::kSupport) continue;
      LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
      p.place = place_of(point, p, s);
      visit(limb, stand_of(limb, point, settings, p, s), p);
    }
  }
}

/// Returns the maximum length of a leg that its hamstrings allow, as a share of its
/// reach; 1 where they do not limit it.
///
/// The muscle spans hip and knee. With a straight knee the trunk closes towards the thigh
/// to `min_trunk_thigh_angle_rad` at most; a knee flexed by f allows f more (knee and hip
/// are taken one to one). A trunk that is d beyond the limit then needs f = 2 d, half of
/// which the tilt of the thigh takes up, and the leg's chord becomes cos(d) of its
/// length: the pelvis sinks, and the trunk keeps its inclination. Applies to legs that
/// are straight in the reference (thesis 4.2.3), and fades out up to twice that flexion.
template <class F>
[[nodiscard]] F hamstring_share(const Plan& plan,
                                const LimbPlan& limb,
                                const Vec3<F>& leg,
                                const Lanes<F>& s) {
  const F one = num<F>(1);
  const F tiny = num<F>(1e-9);
  const auto at = [](int j) { return static_cast<std::size_t>(j); };
  const Vec3<F> trunk = s.place[at(plan.abdomen_high)] - s.place[at(plan.abdomen_low)];
  const F cosine = dot(trunk, leg) / sqrt(max(length2(trunk) * length2(leg), tiny));
  const F& min_cos = s.min_trunk_thigh_cos;
  // cos(limit - angle), from the cosines of both angles.
  const F cos_deficit = min_cos * cosine + safe_sqrt(one - min_cos * min_cos) *
                                               safe_sqrt(one - cosine * cosine);
  const Vec3<F> thigh = s.given_place[at(limb.lower)] - s.given_place[at(limb.upper)];
  const Vec3<F> shank = s.given_place[at(limb.end)] - s.given_place[at(limb.lower)];
  const F knee = dot(thigh, shank) / sqrt(max(length2(thigh) * length2(shank), tiny));
  const F& straight = s.straight_knee_cos;
  const F bent = num<F>(2) * straight * straight - one;
  const F was_straight = smooth((knee - bent) / max(straight - bent, num<F>(1e-4)));
  const F share = one - was_straight * (one - max(cos_deficit, num<F>(0)));
  return select((cosine > min_cos) & (min_cos < one), share, one);
}

/// Returns the distance that the root must sink so that every supporting leg reaches its
/// footprint and respects its hamstrings; 0 in lanes where no drop is necessary. `legs`:
/// true to include reach, false for the hamstrings alone.
template <class F>
[[nodiscard]] F needed_drop(const Plan& plan,
                            const SolveSettings& settings,
                            bool legs,
                            Lanes<F>& s) {
  const F zero = num<F>(0);
  F drop = zero;
  for_each_stand<F>(
      plan, settings, s, [&](const LimbPlan& limb, const auto& stand, auto&) {
        const Vec3<F> leg = stand.ankle - stand.hip;
        const F across2 = leg.x * leg.x + leg.z * leg.z;
        const F straight = safe_sqrt(stand.reach * stand.reach - across2);
        F height = straight;
        F share = num<F>(1);
        if (plan.has_hamstrings()) {
          share = hamstring_share(plan, limb, leg, s);
          const F allowed = share * stand.reach;
          height = max(safe_sqrt(allowed * allowed - across2),
                       min(straight, num<F>(kMinHeight) * stand.reach));
        }
        const F excess = (stand.hip.y - stand.ankle.y) - height;
        const F tolerance = num<F>(kOnFootprint) * stand.reach;
        const Mask<F> counts = stand.active & (excess > tolerance) &
                               ((num<F>(legs ? 1 : 0) > zero) | (share < num<F>(1)));
        drop = select(counts, max(drop, excess), drop);
      });
  return drop;
}

/// Returns the horizontal shift of the root back towards its footprints. Each round
/// corrects for the leg with the largest excess.
template <class F>
[[nodiscard]] Vec3<F> stride_excess(const Plan& plan,
                                    const SolveSettings& settings,
                                    Lanes<F>& s) {
  const F zero = num<F>(0);
  Vec3<F> shift{zero, zero, zero};
  for (int round = 0; round < 8; ++round) {
    F max_excess = zero;
    Vec3<F> step{zero, zero, zero};
    for_each_stand<
        F>(plan, settings, s, [&](const LimbPlan& limb, const auto& stand, auto&) {
      const Vec3<F> was = s.reference_place[static_cast<std::size_t>(limb.end)] -
                          s.reference_place[static_cast<std::size_t>(limb.upper)];
      const F stride = sqrt(was.x * was.x + was.z * was.z);
      const F longest =
          max(num<F>(kMaxStride) * stand.reach, min(stride, num<F>(0.999) * stand.reach));
      const Vec3<F> leg = stand.ankle - (stand.hip + shift);
      const F across = sqrt(leg.x * leg.x + leg.z * leg.z);
      const Mask<F> far =
          stand.active & (across > longest + num<F>(kOnFootprint) * stand.reach);
      const F excess = select(far, across - longest, zero);
      const F back = excess / max(across, num<F>(1e-6));
      step = select(excess > max_excess, Vec3<F>{back * leg.x, zero, back * leg.z}, step);
      max_excess = max(max_excess, excess);
    });
    if (!any(max_excess > zero)) break;
    shift += step;
  }
  return shift;
}

/// Returns true if the point or the foot of a support is off its target position or
/// orientation.
template <class F>
[[nodiscard]] Mask<F> is_off(const PointPlan& point,
                             const LanePoint<F>& p,
                             const Lanes<F>& s) {
  const F tolerance = num<F>(kOnFootprint);
  Mask<F> off = length2(p.target - place_of(point, p, s)) > tolerance * tolerance;
  if (point.stands_flat) {
    const Vec3<F> turn =
        turn_left(s.rotation[static_cast<std::size_t>(point.joint)], p.goal.rotation);
    off = off | (length2(turn) > tolerance * tolerance);
  }
  return off & (p.active > num<F>(0));
}

/// Moves supporting legs to their footprints analytically. Lanes outside `mask`, and feet
/// that are already on target, are not changed.
template <class F>
void close_supports(const Plan& plan,
                    const SolveSettings& settings,
                    const Mask<F>& mask,
                    Lanes<F>& s) {
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    Mask<F> off = num<F>(0) > num<F>(1);
    bool supports = false;
    for (const int k : plan.limbs[l].points) {
      const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
      if (point.goal != GoalKind::kSupport) continue;
      supports = true;
      off = off | is_off(point, s.points[static_cast<std::size_t>(k)], s);
    }
    if (!supports || !any(mask & off)) continue;
    close_limb(plan, static_cast<int>(l), settings, num<F>(0), mask & off, s);
  }
}

/// Fast ground adaptation (Ménardais 2003; thesis 4.2.4.1), in the lanes of `mask`. The
/// root keeps its height if all supporting legs reach their footprints. Otherwise it
/// sinks to the lowest of the heights at which each leg is straight (or as straight as
/// its hamstrings allow), and the legs follow. Where the horizontal distance to the
/// footprint is too large for any height, the root moves closer. Afterwards every support
/// is exact if one position of the root can satisfy all. Precondition: the targets of
/// supports are measured.
template <class F>
void adapt_to_supports(const Plan& plan,
                       const SolveSettings& settings,
                       const Mask<F>& mask,
                       Lanes<F>& s) {
  if (!plan.has_supports) return;
  const F zero = num<F>(0);
  const Vec3<F> none{zero, zero, zero};
  const Vec3<F> back = select(mask, stride_excess(plan, settings, s), none);
  if (any(length2(back) > zero)) shift_root(plan, back, s);
  const F drop = select(mask, needed_drop(plan, settings, true, s), zero);
  if (any(drop > zero)) shift_root(plan, {zero, -drop, zero}, s);
  Mask<F> off = zero > num<F>(1);
  for_each_stand<F>(plan, settings, s, [&](const LimbPlan&, const auto& stand, auto&) {
    const F far = stand.reach * num<F>(1 + kOnFootprint);
    off = off | (stand.active & (length2(stand.ankle - stand.hip) > far * far));
  });
  if (any(mask & off)) reach_supports(plan, settings, mask & off, s);
  close_supports(plan, settings, mask, s);
}

/// Applies the rule of the hamstrings alone (thesis 4.2.3): lowers the pelvis in lanes of
/// `mask` whose trunk bends over a straight supporting leg beyond the limit. The legs are
/// not updated.
template <class F>
void spare_hamstrings(const Plan& plan,
                      const SolveSettings& settings,
                      const Mask<F>& mask,
                      Lanes<F>& s) {
  if (!plan.has_hamstrings() || !plan.has_supports) return;
  const F zero = num<F>(0);
  const F drop = select(mask, needed_drop(plan, settings, false, s), zero);
  if (any(drop > zero)) shift_root(plan, {zero, -drop, zero}, s);
}

/// Returns the mean displacement of the footprints of all supporting limbs. While a
/// support fades, the results with and without it are blended (adapter_state_faded.cpp),
/// so that the anticipation is proportional to the support's activation.
template <class F>
[[nodiscard]] Vec3<F> mean_displacement(const Plan& plan,
                                        const Mask<F>& mask,
                                        const Lanes<F>& s) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Vec3<F> sum{zero, zero, zero};
  F feet = zero;
  for (const LimbPlan& limb : plan.limbs) {
    Vec3<F> moved{zero, zero, zero};
    F count = zero;
    for (const int k : limb.points) {
      const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
      if (point.goal != GoalKind::kSupport) continue;
      const LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
      const Mask<F> active = mask & (p.active > zero);
      const Vec3<F> by = p.target - place_of(point, p, s);
      // Removes rounding errors, continuously at the threshold.
      const F far = length(by);
      const F share =
          max(far - num<F>(kOnFootprint), zero) / max(far, num<F>(kOnFootprint));
      moved += select(active, share, zero) * by;
      count = count + select(active, one, zero);
    }
    sum += (one / max(count, one)) * moved;
    feet = feet + min(count, one);
  }
  return (one / max(feet, one)) * sum;
}

/// Returns the centre of mass of the posture's own body, without loads, as
/// stand_reference() computes it for the given reference.
template <class F>
[[nodiscard]] Vec3<F> own_centre(const Plan& plan, const Lanes<F>& s) {
  Vec3<F> moment{num<F>(0), num<F>(0), num<F>(0)};
  F mass = num<F>(0);
  for (std::size_t m = 0; m < plan.own_masses; ++m) {
    const auto j = static_cast<std::size_t>(plan.masses[m].joint);
    const auto c = static_cast<std::size_t>(plan.masses[m].carried_by);
    const Vec3<F> given =
        s.given_place[j] + rotate(s.given_rotation[j], s.mass_in_joint[m]);
    const Vec3<F> in_carrier =
        rotate(conjugate(s.given_rotation[c]), given - s.given_place[c]);
    moment += s.mass[m] * (s.place[c] + rotate(s.rotation[c], in_carrier));
    mass = mass + s.mass[m];
  }
  return (num<F>(1) / max(mass, num<F>(1e-9))) * moment;
}

/// Complete ground adaptation (thesis 4.2.4.2) of the reference itself, in the lanes of
/// `mask`, including the axes of its limbs. Moves the root by the mean displacement of
/// the footprints, then applies the fast adaptation. Computes `reference_*` from
/// `given_*`, and the target of the centre of mass if that is the reference's own. The
/// posture becomes that reference.
template <class F>
void ground_reference(const Plan& plan,
                      const SolveSettings& settings,
                      bool balance,
                      const Mask<F>& mask,
                      Lanes<F>& s) {
  const F zero = num<F>(0);
  if (!plan.has_supports) {
    set_axes(plan, mask, s);
    return;
  }
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.rotation[i] = select(mask, s.given_rotation[i], s.rotation[i]);
    s.place[i] = select(mask, s.given_place[i], s.place[i]);
    s.reference_rotation[i] = select(mask, s.given_rotation[i], s.reference_rotation[i]);
    s.reference_place[i] = select(mask, s.given_place[i], s.reference_place[i]);
    s.reference_local[i] = select(mask, s.given_local[i], s.reference_local[i]);
  }
  set_axes(plan, mask, s);
  s.com_target = select(mask, s.given_com_target, s.com_target);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    if (point.goal != GoalKind::kSupport) continue;
    s.points[k].place = place_of(point, s.points[k], s);
    s.points[k].target = target_of(point, s.points[k], s);
  }
  const Vec3<F> moved = mean_displacement(plan, mask, s);
  if (any(length2(moved) > zero)) shift_root(plan, moved, s);
  adapt_to_supports(plan, settings, mask, s);
  const Vec3<F> root = s.place[0] - s.given_place[0];
  Mask<F> changed = length2(root) > zero;
  for (const LimbPlan& limb : plan.limbs) {
    const int joints[3] = {limb.upper, limb.lower, limb.end};
    for (const int j : joints) {
      const auto i = static_cast<std::size_t>(j);
      const Quat<F>& a = s.rotation[i];
      const Quat<F>& b = s.given_rotation[i];
      const Mask<F> same = (a.w == b.w) & (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
      changed = changed | !same;
    }
  }
  changed = changed & mask;
  if (!any(changed)) return;
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.reference_rotation[i] = select(changed, s.rotation[i], s.reference_rotation[i]);
    s.reference_place[i] = select(changed, s.place[i], s.reference_place[i]);
    if (j == 0) continue;
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    s.reference_local[i] =
        select(changed, conjugate(s.rotation[p]) * s.rotation[i], s.reference_local[i]);
  }
  if (!balance) return;
  const Mask<F> follows = changed & (s.com_from_reference > num<F>(0.5));
  s.com_target = select(follows, own_centre(plan, s), s.com_target);
}

}  // namespace marey::retarget
