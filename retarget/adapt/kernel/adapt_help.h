// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_ground.h"
#include "retarget/adapt/kernel/adapt_levels.h"

/// Solutions by limbs and root alone, over lanes, and the mobility of the trunk that is
/// needed beyond them.
namespace marey::retarget {

/// Distance of a target, in reaches of its limb, up to which only the limb moves.
inline constexpr double kComfortableReach = 0.96;
/// Distance, in reaches of its limb, from which the trunk has its full mobility.
inline constexpr double kFullHelp = 1.08;
/// Mobility per unit of an error that limbs cannot correct.
inline constexpr double kHelpPerUnit = 10.0;
inline constexpr double kHelpPerUnitMissing = 2.0;
/// With balance: shift of the root, in units, up to which the trunk does not help;
inline constexpr double kNearShift = 0.15;
/// shift from which the trunk has its full mobility.
inline constexpr double kFarShift = 0.4;
/// The same thresholds for the error of the centre of mass that the root leaves.
inline constexpr double kNearLeft = 0.03;
inline constexpr double kFarLeft = 0.15;
/// Distance of the target of the centre of mass from its position in the reference, in
/// units, up to which the root alone moves it;
inline constexpr double kNearTravel = 0.01;
/// distance from which the whole body moves it.
inline constexpr double kFarTravel = 0.05;
/// Maximum drop of the hips in one step, in units.
inline constexpr double kMaxSink = 0.1;
/// Mobility from which the trunk's posture is independent of that of limbs and root
/// alone.
inline constexpr double kOwnWay = 0.05;

/// Number of additional closings of limbs that a limit stopped.
inline constexpr int kMoreClosings = 6;
/// They continue while the error exceeds this, in units,
inline constexpr double kClosed = 1e-5;
/// and while each reduces the error below this share of the previous one.
inline constexpr double kClosesFurther = 0.98;

/// Returns the mobility of the trunk that is needed before limbs move: 0 while the target
/// of every limb is within comfortable reach, or the limb is no more stretched or folded
/// than in the reference; up to 1 beyond.
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
    const Mask<F> requested = is_served(point, p, level);
    if (!supports && point.goal == GoalKind::kSupport) continue;
    // Limb motion does not change the distance of a point on the upper bone.
    if (point.direct || (point.limb >= 0 && point.place == LimbPlace::kUpper)) continue;
    if (point.limb < 0) {
      const F beyond = max(length(p.error) - num<F>(1e-6), num<F>(0));
      const F whole = min(num<F>(kHelpPerUnit) * beyond, one);
      share = select(requested, max(share, whole), share);
      continue;
    }
    const LimbPlan& limb = plan.limbs[static_cast<std::size_t>(point.limb)];
    const Extremity<F> extremity = extremity_of(limb, settings.keeps_orientation, s);
    const LimbTarget<F> limb_target = limb_target_of(limb, point, p, extremity, s);
    const Vec3<F> root = s.place[static_cast<std::size_t>(limb.upper)];
    const Vec3<F> middle = s.place[static_cast<std::size_t>(limb.lower)];
    const F near_bone = length(middle - root);
    const F far_bone = length(limb_target.place - middle);
    const F over_reach = one / max(near_bone + far_bone, num<F>(1e-6));
    const F wanted = length(limb_target.target - root) * over_reach;
    const F now = length(limb_target.place - root) * over_reach;
    const F begin = min(max(now, num<F>(kComfortableReach)), num<F>(0.998));
    const F stretch = smooth((wanted - begin) / (num<F>(kFullHelp) - begin));
    const F min_share = abs(near_bone - far_bone) * over_reach;
    const F fold = min(now, min_share + num<F>(0.12));
    const F tight = min((fold - wanted) / max(fold - min_share, num<F>(0.002)), one);
    // A folded limb has a very short lever: a thousandth of the trunk's mobility moves
    // the point further.
    const F folded = tight * tight * tight * smooth(tight);
    share = select(requested, max(share, max(stretch, folded)), share);
  }
  // Smaller values are rounding errors.
  return select(share < num<F>(1e-7), num<F>(0), share);
}

/// Returns the mobility of the trunk that is needed for the errors that limbs leave: 0 up
/// to half of the precision, proportional beyond, with a smooth transition.
template <class F>
[[nodiscard]] F help_missing(const Errors<F>& errors) {
  const F one = num<F>(1);
  const F beyond =
      max(one - num<F>(0.5) / max(errors.worst_over_precision, num<F>(1e-6)), num<F>(0));
  const F help = num<F>(kHelpPerUnitMissing) * errors.worst * beyond * beyond;
  return min(select(help < num<F>(1e-7), num<F>(0), help), one);
}

/// Lowers the hips where balance has moved the root beyond the reach of a standing leg,
/// because moving back would lose balance. The drop is at most kMaxSink.
template <class F>
void sink_to_supports(const Plan& plan,
                      const SolveSettings& settings,
                      const Mask<F>& mask,
                      Lanes<F>& s) {
  if (!plan.has_supports) return;
  const F zero = num<F>(0);
  const F drop =
      select(mask, min(needed_drop(plan, settings, true, s), num<F>(kMaxSink)), zero);
  if (any(drop > zero)) shift_root(plan, {zero, -drop, zero}, s);
}

/// Calls close_limbs() repeatedly for limbs that a limit stopped, because the remaining
/// path may be free from the new posture. Ends when the improvement is negligible.
template <class F>
void close_limbs_repeatedly(const Plan& plan,
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

/// Returns a smooth weight from 0 to 1 as `length` increases from `near` to `far`.
template <class F>
[[nodiscard]] F fade_between(const F& length, double near, double far) {
  return smooth((length - num<F>(near)) * num<F>(1.0 / (far - near)));
}

/// Computes the posture by limbs and root alone, in the lanes of `mask`: limbs close on
/// their targets, then the root corrects the centre of mass. The resulting posture is
/// measured. Returns the mobility of the trunk that is needed: as without balance, and
/// where the root would have to move far or does not bring the centre of mass to its
/// target. Precondition: the posture is the reference, and its points are measured.
template <class F>
[[nodiscard]] F balance_by_root(const Plan& plan,
                                const SolveSettings& settings,
                                const F& level,
                                const Mask<F>& mask,
                                Errors<F>& errors,
                                Lanes<F>& s) {
  close_limbs_repeatedly(plan, settings, level, mask, s);
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
  close_limbs_repeatedly(plan, settings, level, mask, s);
  errors = measure(plan, true, level, s);
  share = max(share, help_missing(errors));
  share = max(share, fade_between(length(error), kNearShift, kFarShift));
  return max(share, fade_between(errors.balance, kNearLeft, kFarLeft));
}

/// Blends the posture after homing, in the lanes of `mask`, towards the posture of limbs
/// and root alone (the best posture so far) as the mobility of the trunk approaches 0.
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
