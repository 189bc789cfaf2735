// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/thesis_kinematics.h"

/// Kinetic adaptation by groups (Kulpa 2005, chapter 5), over lanes: the centre of mass
/// (COM) to where it is wanted, by the root and by groups that no wish uses.
///
/// Masses are shares of the whole, so that equation 5.5, which isolates a group in the
/// global sum, reads: its own centre has to move by what the body's lacks, over its
/// share.
namespace marey::retarget {

/// The hierarchy of centres of mass (5.1.2) after everything at and below one joint has
/// moved: segments, the group, what carries it, the body. Nothing else is touched. The
/// order of the sums is measure_balance()'s: who has not moved keeps his bits.
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

/// Where a centre that is `from` its root goes by one rotation about it when `wanted` is
/// where it should be: in three dimensions on the line there; horizontally under or over
/// it, on the side where it is (figure 5.8c), not nearest to it. Beyond reach along the
/// floor: as far as it gets. All from the root; `from` is not zero.
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

/// Trunk and head: one rotation, shared by the joints of the group. `error`: how much of
/// what balance lacks is theirs to bring.
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
  const F least2 = num<F>(1e-8);
  const Mask<F> can = weighs & (length2(from) > least2) & (length2(to) > least2);
  if (!any(can)) return;
  turn_joints(plan, group.joints, group.below, turn_or_stay(from, to, can), can, s);
}

/// Arms and legs in two steps (5.2.3.2): first the bend that puts their centre of mass as
/// far from their root as it should be, then the rotation that brings it there.
///
/// Equation 5.6 has the bones' centres on their axes and leaves hands and feet out. Here
/// both parts count with all that moves with them, wherever that is: the limb's centre
/// turns about the point K = (m1 p1 + m2 elbow) / m as the lower part bends, and bending
/// a limb until a point about a joint is at a distance is what bend_to() solves. With
/// centres on the axes it comes to equation 5.6.
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
  // A hand that keeps its orientation hangs from the wrist by the same vector always.
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
  const F least2 = num<F>(1e-8);
  const Mask<F> can = weighs & (length2(from) > least2) & (length2(to) > least2);
  if (!any(can)) return;
  const Quat<F> swing = turn_or_stay(from, to, can);
  turn_limb(plan, limb, {swing, swing * bend}, can, extremity, true, s);
}

/// Lanes in which a group is free for balance (5.3.1): no active wish uses it, by its own
/// segments or by its range. Supports are wishes, too.
template <class F>
[[nodiscard]] Mask<F> is_free(const KineticGroup& group, const Lanes<F>& s) {
  Mask<F> used = num<F>(0) > num<F>(1);
  for (const int k : group.users) {
    used = used | (s.points[static_cast<std::size_t>(k)].active > num<F>(0));
  }
  return !used;
}

/// Moves the root by `share` of what balance lacks, and the legs after it.
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

/// All of what is left, along the axes that the root is willing to move along at all: the
/// thesis ends each round with 100 %, and CnRoot only sets how much of it comes first.
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

/// What groups of one rank are to bring of what balance lacks now, over the mass that the
/// free ones have together: each as much as its own mass is of theirs, as if they were
/// one. The thesis has them one after the other, and the left arm before the right.
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

/// The kinetic half of an iteration (5.2.2): the root by CnRoot, the groups from heavy to
/// light, the root by what is left; only the root where no group is free. Lanes that are
/// balanced are not touched.
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
