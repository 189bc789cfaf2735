// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/thesis_kinematics.h"

/// Kinetic adaptation by groups (Kulpa 2005, chapter 5), over lanes: moves the centre of
/// mass (COM) to its target by the root and by groups without targets.
///
/// Masses are fractions of the total. Equation 5.5, which isolates a group in the global
/// sum, then reads: the group's own centre moves by the error of the body's centre,
/// divided by the group's fraction.
namespace marey::retarget {

/// Updates the hierarchy of centres of mass (5.1.2) after everything at and below one
/// joint has moved: segments, the group, its ancestors, the body. The sums have the order
/// of measure_balance(), so values of unmoved parts are equal to the bit.
template <class F>
void update_balance(const Plan& plan, const std::vector<int>& below, Lanes<F>& s) {
  const auto root = static_cast<std::size_t>(below.front());
  const Vec3<F> before = s.below_moment[root];
  for (const int j : below) {
    const auto i = static_cast<std::size_t>(j);
    s.below_moment[i] =
        s.carried_mass[i] * (s.place[i] + rotate(s.rotation[i], s.carried_in_joint[i]));
  }
  for (std::size_t n = below.size(); n-- > 1;) {
    const auto i = static_cast<std::size_t>(below[n]);
    s.below_moment[static_cast<std::size_t>(plan.parent[i])] += s.below_moment[i];
  }
  const Vec3<F> change = s.below_moment[root] - before;
  for (int j = plan.parent[root]; j >= 0; j = plan.parent[static_cast<std::size_t>(j)]) {
    s.below_moment[static_cast<std::size_t>(j)] += change;
  }
  s.com += (num<F>(1) / max(s.below_mass[0], num<F>(1e-9))) * change;
}

/// Returns the position that a centre at `from` reaches by one rotation about its root
/// for the target `wanted`. In three dimensions it is on the line to the target.
/// Horizontally it is under or over the target, on the side where the centre is (figure
/// 5.8c), not the nearest one. Beyond horizontal reach it is as far as possible. All
/// positions are relative to the root; `from` is not zero.
template <class F>
[[nodiscard]] Vec3<F> reached_by_turning(const Vec3<F>& from,
                                         const Vec3<F>& wanted,
                                         const F& vertical) {
  const F zero = num<F>(0);
  const F radius2 = length2(from);
  const F across2 = wanted.x * wanted.x + wanted.z * wanted.z;
  const F shrink = min(num<F>(1), safe_sqrt(radius2 / max(across2, num<F>(1e-12))));
  const F height = safe_sqrt(radius2 - across2);
  const F up = select(wanted.y < zero, -height, height);
  return select(vertical > zero, wanted, {shrink * wanted.x, up, shrink * wanted.z});
}

template <class F>
[[nodiscard]] Quat<F> turn_or_stay(const Vec3<F>& from,
                                   const Vec3<F>& to,
                                   const Mask<F>& can) {
  const Vec3<F> up{num<F>(0), num<F>(1), num<F>(0)};
  const Vec3<F> from_or_up = select(can, from, up);
  return rotation_onto(from_or_up, select(can, to, up), across(from_or_up));
}

/// Balances trunk and head by one rotation, shared by the joints of the group. `error`:
/// the group's part of the balance error.
template <class F>
void balance_with_segment(const Plan& plan,
                          const KineticGroup& group,
                          const Vec3<F>& error,
                          const Mask<F>& mask,
                          Lanes<F>& s) {
  const auto root = static_cast<std::size_t>(group.root);
  const F share = s.below_mass[root] / max(s.below_mass[0], num<F>(1e-9));
  const Mask<F> weighs = mask & (share > num<F>(1e-4));
  const Vec3<F> com =
      (num<F>(1) / max(s.below_mass[root], num<F>(1e-9))) * s.below_moment[root];
  const Vec3<F> pivot = pivot_of(group.joints, s);
  const Vec3<F> from = com - pivot;
  const Vec3<F> wanted = from + (num<F>(1) / max(share, num<F>(1e-4))) * error;
  const Vec3<F> to = reached_by_turning(from, wanted, s.vertical);
  const F min_length2 = num<F>(1e-8);
  const Mask<F> can =
      weighs & (length2(from) > min_length2) & (length2(to) > min_length2);
  if (!any(can)) return;
  turn_joints(plan, group.joints, group.below, turn_or_stay(from, to, can), can, s);
}

/// Balances arms and legs in two steps (5.2.3.2): first the bend that brings their centre
/// of mass to the target distance from their root, then the rotation to the target.
///
/// Equation 5.6 assumes the bones' centres on their axes and omits hands and feet. Here
/// both parts include all that moves with them. The limb's centre rotates about the point
/// K = (m1 p1 + m2 elbow) / m as the lower part bends, and bend_to() solves for the bend
/// at which a point about a joint has a given distance. With centres on the axes this
/// equals equation 5.6.
template <class F>
void balance_with_limb(const Plan& plan,
                       const KineticGroup& group,
                       const SolveSettings& settings,
                       const Vec3<F>& error,
                       const Mask<F>& mask,
                       Lanes<F>& s) {
  const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(group.limb)];
  const auto u = static_cast<std::size_t>(limb.upper);
  const auto l = static_cast<std::size_t>(limb.lower);
  const auto e = static_cast<std::size_t>(limb.end);
  const F tiny = num<F>(1e-9);
  const F mass = s.below_mass[u];
  const F share = mass / max(s.below_mass[0], tiny);
  const Mask<F> weighs = mask & (share > num<F>(1e-4));
  if (!any(weighs)) return;
  const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
  // A hand that keeps its orientation has a constant offset from the wrist.
  const Vec3<F> none{num<F>(0), num<F>(0), num<F>(0)};
  const Vec3<F> kept =
      select(extremity.is_set, s.below_moment[e] - s.below_mass[e] * s.place[e], none);
  const F per_mass = num<F>(1) / max(mass, tiny);
  const Vec3<F>& root = s.place[u];
  const Vec3<F>& middle = s.place[l];
  const Vec3<F> lower = s.below_moment[l] - s.below_mass[l] * middle - kept;
  const Vec3<F> centre =
      per_mass * (s.below_moment[u] - s.below_moment[l] + s.below_mass[l] * middle);
  const Vec3<F> from_centre = per_mass * lower;
  const Vec3<F> com = centre + from_centre;
  const Vec3<F> wanted = com - root + (num<F>(1) / max(share, num<F>(1e-4))) * error;
  const Quat<F> bend = bend_to(limb_axis(limb, s, group.limb),
                               root - centre,
                               s.place[e] - middle,
                               from_centre,
                               length(wanted));
  const Vec3<F> from = centre + rotate(bend, from_centre) - root;
  const Vec3<F> to = reached_by_turning(from, wanted, s.vertical);
  const F min_length2 = num<F>(1e-8);
  const Mask<F> can =
      weighs & (length2(from) > min_length2) & (length2(to) > min_length2);
  if (!any(can)) return;
  const Quat<F> swing = turn_or_stay(from, to, can);
  turn_limb(plan, limb, {swing, swing * bend}, can, extremity, true, s);
}

/// Returns the lanes in which a group is free for balance (5.3.1): no active target uses
/// it, by its own segments or by its range. Supports are targets, too.
template <class F>
[[nodiscard]] Mask<F> is_free(const KineticGroup& group, const Lanes<F>& s) {
  Mask<F> used = num<F>(0) > num<F>(1);
  for (const int k : group.users) {
    used = used | (s.points[static_cast<std::size_t>(k)].active > num<F>(0));
  }
  return !used;
}

/// Moves the root by `share` of the balance error, and the legs after it.
template <class F>
void balance_with_root(const Plan& plan,
                       const SolveSettings& settings,
                       const Vec3<F>& share,
                       const Mask<F>& mask,
                       Lanes<F>& s) {
  const F zero = num<F>(0);
  const Vec3<F> e = balance_error(s);
  const Vec3<F> shift{share.x * e.x, share.y * e.y, share.z * e.z};
  shift_root(plan, select(mask, shift, Vec3<F>{zero, zero, zero}), s);
  adapt_to_supports(plan, settings, mask, s);
  measure_balance(plan, s);
}

/// Moves the root by the whole remaining error along the axes on which the root may move:
/// the thesis ends each round with 100 %, and CnRoot only sets the share at the start.
template <class F>
[[nodiscard]] inline Vec3<F> all_of_root(const Lanes<F>& s) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F floor = select(s.root_weight_on_floor > zero, one, zero);
  return {floor, select(s.root_weight > zero, one, zero), floor};
}

template <class F>
[[nodiscard]] inline Mask<F> is_unbalanced(const Lanes<F>& s) {
  return length(balance_error(s)) > s.balance_precision;
}

/// Returns the balance error for the groups of one rank, divided by the total mass of the
/// free ones: each contributes in proportion to its mass, as if they were one group. The
/// thesis processes them in sequence, the left arm before the right.
template <class F>
[[nodiscard]] Vec3<F> error_per_mass(const ThesisPlan& thesis,
                                     int rank,
                                     const Lanes<F>& s) {
  F mass = num<F>(0);
  for (const KineticGroup& group : thesis.balancing) {
    if (group.rank != rank) continue;
    const F own = s.below_mass[static_cast<std::size_t>(group.root)];
    mass = mass + select(is_free(group, s), own, num<F>(0));
  }
  return (num<F>(1) / max(mass, num<F>(1e-9))) * balance_error(s);
}

/// Performs the kinetic half of an iteration (5.2.2): the root by CnRoot, the groups from
/// heavy to light, the root by the remaining error; only the root where no group is free.
/// Lanes in balance are unchanged.
template <class F>
void adapt_balance(const Plan& plan,
                   const ThesisPlan& thesis,
                   const SolveSettings& settings,
                   const Mask<F>& mask,
                   Lanes<F>& s) {
  const F one = num<F>(1);
  measure_balance(plan, s);
  const Mask<F> off = mask & is_unbalanced(s);
  if (!any(off)) return;
  Mask<F> has_groups = num<F>(0) > one;
  for (const KineticGroup& group : thesis.balancing) {
    has_groups = has_groups | is_free(group, s);
  }
  const Vec3<F> all = all_of_root(s);
  const F floor = select(has_groups, s.root_weight_on_floor, all.x);
  const F up = select(has_groups, s.root_weight, all.y);
  balance_with_root(plan, settings, {floor, up, floor}, off, s);
  int rank = -1;
  Mask<F> still = off;
  Vec3<F> per_mass{};
  for (const KineticGroup& group : thesis.balancing) {
    if (group.rank != rank) {
      rank = group.rank;
      still = off & is_unbalanced(s);
      per_mass = error_per_mass(thesis, rank, s);
    }
    const Mask<F> uses = still & is_free(group, s);
    if (!any(uses)) continue;
    const Vec3<F> error = s.below_mass[static_cast<std::size_t>(group.root)] * per_mass;
    if (group.limb >= 0) {
      balance_with_limb(plan, group, settings, error, uses, s);
    } else {
      balance_with_segment(plan, group, error, uses, s);
    }
    update_balance(plan, group.below, s);
  }
  const Mask<F> left = off & is_unbalanced(s);
  if (any(left)) balance_with_root(plan, settings, all, left, s);
}

}  // namespace marey::retarget
