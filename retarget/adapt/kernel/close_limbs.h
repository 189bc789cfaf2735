// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/limb_closure.h"

namespace marey::retarget {

/// Settings of a whole solve, common to all lanes.
struct SolveSettings {
  bool blend = false;  ///< Control::kBlend.
  /// Limbs with two targets take the weighted mean of both. Off where whole-body steps
  /// compute the compromise, because closing would undo it.
  bool mixes = true;
  bool keeps_orientation = false;  ///< For extremities.
  int max_iterations = 50;
};

/// Weight of a support in the count of a limb's targets (without_mixed_limbs()). With it
/// the count stays below two for up to ten other targets: a support is never part of a
/// compromise, so the limb is closed.
inline constexpr int kSupportInTargetCount = -9;
/// Rounds of reach_supports(). One or two are usual; more are needed only if two legs are
/// out of reach in almost opposite directions, where projections converge slowly.
inline constexpr int kMaxReachRounds = 16;
/// Excess of a leg's length below which its support counts as within reach. It is below
/// the resolution of single precision at 1 m. [m]
inline constexpr double kReachTolerance_m = 1e-7;
/// Share of a leg's length up to which it is stretched: slightly less than straight, so
/// that rounding does not put the foot out of reach.
inline constexpr double kMaxStretch = 0.999999;
/// Smallest divisor in the direction to a support. [m]
inline constexpr double kMinDistance_m = 1e-6;

/// Returns the lanes in which a target is active and at most of level `level`.
template <class F>
[[nodiscard]] inline Mask<F> is_requested(const PointPlan& point,
                                          const LanePoint<F>& p,
                                          const F& level) {
  return (p.active > num<F>(0)) & (num<F>(point.level) <= level);
}

/// Returns the lanes in which the body moves for a requested target: not those in which
/// its point is on a standing foot.
template <class F>
[[nodiscard]] inline Mask<F> is_served(const PointPlan& point,
                                       const LanePoint<F>& p,
                                       const F& level) {
  const Mask<F> requested = is_requested(point, p, level);
  return point.firm_under.empty() ? requested : requested & (p.firm < num<F>(0.5));
}

/// A point that a limb moves, and its target. [m]
template <class F>
struct LimbTarget {
  Vec3<F> place;   ///< Current position.
  Vec3<F> target;  ///< Position after closing, if it is in reach.
};

/// Returns the point and target for closing `limb` on `point`: the point itself, or for a
/// point of an extremity with its own orientation the wrist or ankle, whose target has
/// the offset of the rotated extremity.
template <class F>
[[nodiscard]] LimbTarget<F> limb_target_of(const LimbPlan& limb,
                                           const PointPlan& point,
                                           const LanePoint<F>& p,
                                           const Extremity<F>& extremity,
                                           const Lanes<F>& s) {
  if (point.place != LimbPlace::kExtremity || point.joint != limb.end) {
    return {p.place, p.target};
  }
  const Vec3<F>& end = s.place[static_cast<std::size_t>(limb.end)];
  return {
      select(extremity.is_set, end, p.place),
      select(
          extremity.is_set, p.target - rotate(extremity.rotation, p.in_joint), p.target)};
}

/// Interpolates between two postures of one limb in the lanes of `mask`: from the current
/// one (`share` 0) to `other` (`share` 1), the rotations of upper bone, lower bone and
/// extremity.
template <class F>
void mix_limb(const Plan& plan,
              const LimbPlan& limb,
              const Quat<F> (&other)[3],
              const F& share,
              const Mask<F>& mask,
              const Extremity<F>& extremity,
              Lanes<F>& s) {
  const int joints[3] = {limb.upper, limb.lower, limb.end};
  Quat<F> turn[3];
  for (std::size_t n = 0; n < 3; ++n) {
    const Quat<F>& now = s.rotation[static_cast<std::size_t>(joints[n])];
    const Quat<F> mixed = between(now, other[n], share);
    turn[n] = mixed * conjugate(now);
  }
  turn_limb(plan, limb, {turn[0], turn[1]}, mask, extremity, true, s);
}

/// Moves the first active target's point of a limb back to its target, in lanes of `mask`
/// where the target `later` has moved it.
template <class F>
void close_first_again(const Plan& plan,
                       int number,
                       int later,
                       const F& level,
                       const Mask<F>& mask,
                       const Extremity<F>& extremity,
                       Lanes<F>& s) {
  const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(number)];
  Mask<F> left = mask;
  for (const int k : limb.points) {
    if (k == later) return;
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
    const Mask<F> first = left & is_served(point, p, level);
    if (!any(first)) continue;
    p.place = place_of(point, p, s);
    const LimbTarget<F> limb_target = limb_target_of(limb, point, p, extremity, s);
    close_limb_on(
        plan, number, point, limb_target.place, limb_target.target, first, extremity, s);
    left = left & !first;
  }
}

/// Returns `wanted` without the lanes in which whole-body steps compute the compromise of
/// a limb with two targets or more.
template <class F>
[[nodiscard]] Mask<F> without_mixed_limbs(const Plan& plan,
                                          const LimbPlan& limb,
                                          const SolveSettings& settings,
                                          const F& level,
                                          const Mask<F>& wanted,
                                          const Lanes<F>& s) {
  if (!settings.blend || settings.mixes || limb.points.size() <= 1) return wanted;
  F target_count = num<F>(0);
  for (const int k : limb.points) {
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    const F counts = num<F>(point.goal == GoalKind::kSupport ? kSupportInTargetCount : 1);
    target_count = target_count +
                   select(is_served(point, s.points[static_cast<std::size_t>(k)], level),
                          counts,
                          num<F>(0));
  }
  return wanted & (target_count < num<F>(1.5));
}

/// Closes one limb on its active targets: exactly or optimally for the first, with the
/// remaining freedom for the second; or on both by their weights (thesis 4.2.2).
template <class F>
void close_limb(const Plan& plan,
                int number,
                const SolveSettings& settings,
                const F& level,
                const Mask<F>& wanted,
                Lanes<F>& s) {
  const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(number)];
  const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
  const Mask<F> mask = without_mixed_limbs(plan, limb, settings, level, wanted, s);
  Mask<F> taken = num<F>(0) > num<F>(1);
  Mask<F> firm = taken;  // Taken by a support.
  Vec3<F> first_place{};
  F first_weight = num<F>(1);
  for (const int k : limb.points) {
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
    const Mask<F> requested = mask & is_served(point, p, level);
    if (!any(requested)) continue;
    p.place = place_of(point, p, s);
    const LimbTarget<F> limb_target = limb_target_of(limb, point, p, extremity, s);
    if (any(requested & !taken)) {
      close_limb_on(plan,
                    number,
                    point,
                    limb_target.place,
                    limb_target.target,
                    requested & !taken,
                    extremity,
                    s);
    }
    // Supports are never part of a compromise.
    const Mask<F> blends =
        requested & taken & !firm & (num<F>(settings.blend ? 1 : 0) > num<F>(0.5));
    const Mask<F> spins = requested & taken & !blends;
    if (any(blends)) {
      const Quat<F> before[3] = {s.rotation[static_cast<std::size_t>(limb.upper)],
                                 s.rotation[static_cast<std::size_t>(limb.lower)],
                                 s.rotation[static_cast<std::size_t>(limb.end)]};
      close_limb_on(plan,
                    number,
                    point,
                    limb_target.place,
                    limb_target.target,
                    blends,
                    extremity,
                    s);
      const F share = first_weight / (first_weight + p.weight);
      mix_limb(plan, limb, before, share, blends, extremity, s);
    }
    if (any(spins)) {
      spin_limb_on(plan,
                   number,
                   first_place,
                   limb_target.place,
                   limb_target.target,
                   spins,
                   extremity,
                   s);
      // A limit may have stopped the spin and moved the first point.
      if (plan.has_limits) {
        close_first_again(plan, number, k, level, spins, extremity, s);
      }
    }
    p.place = place_of(point, p, s);
    // Later targets spin about the point that the limb itself positioned: for a foot with
    // its own orientation, the ankle.
    first_place =
        select(taken, first_place, limb_target_of(limb, point, p, extremity, s).place);
    first_weight = select(taken, first_weight, p.weight);
    if (point.goal == GoalKind::kSupport) firm = firm | requested;
    taken = taken | requested;
  }
  // An extremity without a position target may have an orientation target.
  const Mask<F> only_turned = mask & extremity.is_set & !taken;
  if (any(only_turned)) {
    turn_limb(
        plan, limb, {identity<F>(), identity<F>()}, only_turned, extremity, true, s);
  }
}

/// Resets limbs with targets to their posture in the reference, on the current trunk.
template <class F>
void rest_limbs(const Plan& plan, const F& level, const Mask<F>& mask, Lanes<F>& s) {
  for (const LimbPlan& limb : plan.limbs) {
    Mask<F> served = num<F>(0) > num<F>(1);
    for (const int k : limb.points) {
      const auto i = static_cast<std::size_t>(k);
      served = served | is_served(plan.points[i], s.points[i], level);
    }
    served = served & mask;
    for (const int j : limb.own) {
      const auto i = static_cast<std::size_t>(j);
      const auto p = static_cast<std::size_t>(plan.parent[i] < 0 ? 0 : plan.parent[i]);
      s.rotation[i] =
          select(served, trued(s.rotation[p] * s.reference_local[i]), s.rotation[i]);
      if (j != 0) place_joint(plan, s, j);
    }
  }
}

/// Moves the root by the smallest shift that brings every support within its leg's reach,
/// if one position does. Uses projections; each round corrects the leg with the largest
/// excess, so that the order of legs does not matter. Thesis 4.2.4: supports are always
/// satisfied.
template <class F>
void reach_supports(const Plan& plan,
                    const SolveSettings& settings,
                    const Mask<F>& mask,
                    Lanes<F>& s) {
  const F zero = num<F>(0);
  Vec3<F> shift{zero, zero, zero};
  Mask<F> left = mask;
  for (int round = 0; round < kMaxReachRounds; ++round) {
    F max_excess = num<F>(kReachTolerance_m);
    Vec3<F> step{zero, zero, zero};
    Mask<F> moved = num<F>(0) > num<F>(1);
    for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
      const LimbPlan& limb = plan.limbs[l];
      for (const int k : limb.points) {
        const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
        if (point.goal != GoalKind::kSupport) continue;
        const LanePoint<F>& p = s.points[static_cast<std::size_t>(k)];
        const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
        const LimbTarget<F> limb_target = limb_target_of(limb, point, p, extremity, s);
        const Vec3<F> root = s.place[static_cast<std::size_t>(limb.upper)];
        const Vec3<F> middle = s.place[static_cast<std::size_t>(limb.lower)];
        const F reach = num<F>(kMaxStretch) *
                        (length(middle - root) + length(limb_target.place - middle));
        const Vec3<F> gap = limb_target.target - (root + shift);
        const F distance = length(gap);
        const F excess =
            select(left & (p.active > zero), max(distance - reach, zero), zero);
        const Mask<F> takes = excess > max_excess;
        step =
            select(takes, (excess / max(distance, num<F>(kMinDistance_m))) * gap, step);
        max_excess = max(max_excess, excess);
        moved = moved | takes;
      }
    }
    shift += step;
    if (!any(moved)) break;
    // Lanes that are near enough stay, independent of the rounds of other lanes.
    left = left & moved;
  }
  if (!any(length2(shift) > zero)) return;
  s.place[0] += shift;
  place_live_joints(plan, s);
}

/// Moves the root until the supports are in reach, then closes every limb that has a
/// target, in the lanes of `mask`.
template <class F>
void close_limbs(const Plan& plan,
                 const SolveSettings& settings,
                 const F& level,
                 const Mask<F>& mask,
                 Lanes<F>& s) {
  reach_supports(plan, settings, mask, s);
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const LimbPlan& limb = plan.limbs[l];
    if (limb.points.empty() && limb.orientations.empty() && !settings.keeps_orientation) {
      continue;
    }
    close_limb(plan, static_cast<int>(l), settings, level, mask, s);
  }
}

}  // namespace marey::retarget
