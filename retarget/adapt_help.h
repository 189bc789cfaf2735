// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_ground.h"
#include "retarget/adapt_levels.h"

/// What limbs and root do alone, over lanes, and how much the trunk has to help.
namespace marey::retarget {

/// Up to here, in reaches of its limb, a wish is the limb's alone.
inline constexpr double kComfortableReach = 0.96;
/// A wish this far, in reaches of its limb, has all of the trunk's mobility.
inline constexpr double kFullHelp = 1.08;
/// Mobility per unit of an error that limbs cannot mend.
inline constexpr double kHelpPerUnit = 10.0;
inline constexpr double kHelpPerUnitMissing = 2.0;
/// With balance the root moves up to here before the trunk helps, in units,
inline constexpr double kNearShift = 0.15;
/// and from here on the trunk has all of its mobility.
inline constexpr double kFarShift = 0.4;
/// The same of what the root leaves of the centre of mass's way.
inline constexpr double kNearLeft = 0.03;
inline constexpr double kFarLeft = 0.15;
/// A centre of mass that is wanted no further from the reference's own than this, in
/// units, is the root's to bring,
inline constexpr double kNearTravel = 0.01;
/// and from here on the whole body's.
inline constexpr double kFarTravel = 0.05;
/// Hips sink by no more at once, in units.
inline constexpr double kDeepestSink = 0.1;
/// A trunk of this mobility goes its own way.
inline constexpr double kOwnWay = 0.05;

/// How often limbs that a limit stopped are closed again,
inline constexpr int kMoreClosings = 6;
/// while they are further than this from their targets, in units,
inline constexpr double kClosed = 1e-5;
/// and each time brings them nearer than this share of what was left.
inline constexpr double kClosesFurther = 0.98;

/// How much the trunk has to help, before limbs moved: 0 while every limb stays in
/// comfortable reach of its wish, or no further stretched or folded than in the
/// reference; 1 beyond.
template <class F>
[[nodiscard]] F help_needed(const Plan& plan,
                            const SolveSettings& settings,
                            bool supports,
                            const F& level,
                            const Lanes<F>& s) {
  const F one = num<F>(1);
  F share = num<F>(0);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const LanePoint<F>& p = s.points[k];
    const Mask<F> asked = is_served(point, p, level);
    if (!supports && point.goal == GoalKind::kSupport) continue;
    // The distance of a point on the upper bone is what it is.
    if (point.direct || (point.limb >= 0 && point.place == LimbPlace::kUpper)) continue;
    if (point.limb < 0) {
      const F beyond = max(length(p.error) - num<F>(1e-6), num<F>(0));
      const F whole = min(num<F>(kHelpPerUnit) * beyond, one);
      share = select(asked, max(share, whole), share);
      continue;
    }
    const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(point.limb)];
    const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
    const LimbWish<F> wish = wish_of(limb, point, p, extremity, s);
    const Vec3<F> root = s.place[static_cast<std::size_t>(limb.upper)];
    const Vec3<F> middle = s.place[static_cast<std::size_t>(limb.lower)];
    const F near_bone = length(middle - root);
    const F far_bone = length(wish.place - middle);
    const F over_reach = one / max(near_bone + far_bone, num<F>(1e-6));
    const F wanted = length(wish.target - root) * over_reach;
    const F now = length(wish.place - root) * over_reach;
    const F begin = min(max(now, num<F>(kComfortableReach)), num<F>(0.998));
    const F stretch = smooth((wanted - begin) / (num<F>(kFullHelp) - begin));
    const F least = abs(near_bone - far_bone) * over_reach;
    const F fold = min(now, least + num<F>(0.12));
    const F tight = min((fold - wanted) / max(fold - least, num<F>(0.002)), one);
    // A folded limb has next to no lever: a thousandth of the trunk's mobility outdoes
    // it.
    const F folded = tight * tight * tight * smooth(tight);
    share = select(asked, max(share, max(stretch, folded)), share);
  }
  // Less than this is rounding's.
  return select(share < num<F>(1e-7), num<F>(0), share);
}

/// What limbs leave the trunk has to do: nothing up to half of the precision, and from
/// there on in proportion, gently at first.
template <class F>
[[nodiscard]] F help_missing(const Errors<F>& errors) {
  const F one = num<F>(1);
  const F beyond =
      max(one - num<F>(0.5) / max(errors.worst_over_precision, num<F>(1e-6)), num<F>(0));
  const F help = num<F>(kHelpPerUnitMissing) * errors.worst * beyond * beyond;
  return min(select(help < num<F>(1e-7), num<F>(0), help), one);
}

/// Where balance has moved the root so that a standing leg is too short, the hips sink:
/// to come back would take balance away. No further than kDeepestSink at once.
template <class F>
void sink_to_supports(const Plan& plan,
                      const SolveSettings& settings,
                      const Mask<F>& mask,
                      Lanes<F>& s) {
  if (!plan.has_supports) return;
  const F zero = num<F>(0);
  const F drop =
      select(mask, min(needed_drop(plan, settings, true, s), num<F>(kDeepestSink)), zero);
  if (any(drop > zero)) shift_root(plan, {zero, -drop, zero}, s);
}

/// close_limbs(), and again for limbs that a limit stopped on their way: from where they
/// are now the rest of the way may be free. Ends where that brings next to nothing.
template <class F>
void close_limbs_patiently(const Plan& plan,
                           const SolveSettings& settings,
                           const F& level,
                           const Mask<F>& mask,
                           Lanes<F>& s) {
  close_limbs(plan, settings, level, mask, s);
  if (!plan.has_limits) return;
  Mask<F> off = mask;
  F before = num<F>(1e9);
  for (int round = 0; round < kMoreClosings; ++round) {
    const F worst = measure(plan, false, level, s).worst;
    off = off & (worst > num<F>(kClosed)) & (worst < num<F>(kClosesFurther) * before);
    if (!any(off)) return;
    before = worst;
    close_limbs(plan, settings, level, off, s);
  }
}

/// From 0 to 1 as `length` goes from `near` to `far`.
template <class F>
[[nodiscard]] F fade_between(const F& length, double near, double far) {
  return smooth((length - num<F>(near)) * num<F>(1.0 / (far - near)));
}

/// The answer of limbs and root alone, in the lanes of `mask`: limbs take their wishes,
/// and the root moves by what the centre of mass lacks then. Leaves that posture,
/// measured. Returns how much the trunk has to help: as without balance, and where the
/// root would have to move far, or does not bring the centre of mass to its place.
/// Precondition: the posture is the reference, its points measured.
template <class F>
[[nodiscard]] F balance_by_root(const Plan& plan,
                                const SolveSettings& settings,
                                const F& level,
                                const Mask<F>& mask,
                                Errors<F>& errors,
                                Lanes<F>& s) {
  close_limbs_patiently(plan, settings, level, mask, s);
  measure_balance(plan, s);
  keep_as_best(plan, mask, s);
  const Vec3<F> error = balance_error(s);
  const Vec3<F> by = {s.root_weight_on_floor * error.x,
                      s.root_weight * error.y,
                      s.root_weight_on_floor * error.z};
  const Vec3<F> shift = select(mask, by, Vec3<F>{num<F>(0), num<F>(0), num<F>(0)});
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  shift_root(plan, shift, s);
  measure_points(plan, s, level);
  F share = help_needed(plan, settings, false, level, s);
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  shift_root(plan, shift, s);
  sink_to_supports(plan, settings, mask, s);
  measure_points(plan, s, level);
  close_limbs_patiently(plan, settings, level, mask, s);
  errors = measure(plan, true, level, s);
  share = max(share, help_missing(errors));
  share = max(share, fade_between(length(error), kNearShift, kFarShift));
  return max(share, fade_between(errors.balance, kNearLeft, kFarLeft));
}

/// After homing, where the trunk hardly helps: the nearer its mobility is to nothing, the
/// nearer to what limbs and root did alone (the best posture so far), in the lanes of
/// `mask`.
template <class F>
void rest_on_root(const Plan& plan, const Mask<F>& mask, Lanes<F>& s) {
  const F one = num<F>(1);
  const F share = smooth(s.mobility * num<F>(1.0 / kOwnWay));
  const Mask<F> rests = mask & (share < one);
  if (!any(rests)) return;
  const auto local = [&](const std::vector<Quat<F>>& rotation, int j) {
    const auto i = static_cast<std::size_t>(j);
    if (j == 0) return rotation[i];
    return conjugate(rotation[static_cast<std::size_t>(plan.parent[i])]) * rotation[i];
  };
  for (const int j : plan.live) {
    s.local[static_cast<std::size_t>(j)] =
        between(local(s.best_rotation, j), local(s.rotation, j), share);
  }
  s.place[0] =
      select(rests, s.best_place[0] + share * (s.place[0] - s.best_place[0]), s.place[0]);
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const Quat<F>& own = s.local[i];
    const Quat<F> mixed =
        j == 0 ? own : s.rotation[static_cast<std::size_t>(plan.parent[i])] * own;
    s.rotation[i] = select(rests, trued(mixed), s.rotation[i]);
    if (j != 0) place_joint(plan, s, j);
  }
}

}  // namespace marey::retarget
