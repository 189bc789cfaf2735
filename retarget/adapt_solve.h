// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_errors.h"
#include "retarget/adapt_ground.h"
#include "retarget/close_limbs.h"
#include "retarget/whole_body_solve.h"

/// The strict method, over lanes.
///
/// 1. Limbs alone: every limb takes its wish analytically. While all are within
///    comfortable reach that is the answer (the thesis: the trunk moves only when limbs
///    do not suffice), and no loop runs.
/// 2. The whole body: damped Gauss-Newton steps say how the trunk moves; after each the
///    limbs take their wishes again, analytically, from where the reference has them.
///    The first kHomingSteps also turn every joint back towards the reference, so that
///    the posture is near the nearest one; there are always as many, and each later step
///    is in proportion to what is still missing. So the answer is a continuous function
///    of the targets although the number of steps is not.
/// 3. Between a limb's comfortable reach and kFullHelp the trunk's mobility fades in: it
///    starts to help before an arm is straight, and by nothing at first.
///
/// All levels of importance are tried at once. Where that does not meet every wish, and
/// importance is priority, they are solved from the reference again, one after the other:
/// what the higher have reached is held, and a step that takes some of it away does not
/// count. Supports come before the centre of mass, and that before constraints.
namespace marey::retarget {

/// Up to here, in reaches of its limb, a wish is the limb's alone.
inline constexpr double kComfortableReach = 0.96;
/// A wish this far, in reaches of its limb, has all of the trunk's mobility.
inline constexpr double kFullHelp = 1.08;
/// These two are promised to callers (retarget/adapter.h).
inline constexpr int kHomingSteps = 4;
/// With balance fewer, that end more gently: the centre of mass has to be met, too.
inline constexpr int kHomingStepsBalanced = 3;
inline constexpr double kHomingFades = 0.5;
/// The third step in a row that hardly helps ends the loop.
inline constexpr double kStalledSteps = 2.5;
/// Held points may give way by this much, in units: rounding's.
inline constexpr double kHeldSlack = 2e-5;
/// Steps for supports and balance alone, after constraints took balance away.
inline constexpr int kBalanceSteps = 10;
/// Mobility per unit of an error that limbs cannot mend.
inline constexpr double kHelpPerUnit = 10.0;
inline constexpr double kHelpPerUnitMissing = 2.0;

/// What is kept of a solve from one turn of its loop to the next.
template <class F>
struct Solve {
  Progress<F> progress;
  F needs_body{};  ///< 0: limbs were enough.
  F held_error{};  ///< Of held points, when their level was done.
  F by_level{};    ///< 1: all levels at once did not do.
};

/// What of a plan the strict method goes by.
struct Shape {
  RowOrder rows;
  double last_level = 1.0;  ///< Of importance; 1 is the highest.
  bool by_level = true;     ///< Control::kPriority.
};

/// Live joints as `rotation` and `place` have them, in the lanes of `mask`.
template <class F>
void take_posture(const std::vector<Quat<F>>& rotation,
                  const std::vector<Vec3<F>>& place,
                  const Plan& plan,
                  const Mask<F>& mask,
                  Lanes<F>& s) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.rotation[i] = select(mask, rotation[i], s.rotation[i]);
    s.place[i] = select(mask, place[i], s.place[i]);
  }
}

/// How much the trunk has to help, before limbs moved: 0 while every limb stays in
/// comfortable reach of its wish, or no further stretched or folded than in the
/// reference; 1 beyond.
template <class F>
[[nodiscard]] F help_needed(const Plan& plan,
                            const SolveSettings& settings,
                            const F& level,
                            const Lanes<F>& s) {
  const F one = num<F>(1);
  F share = num<F>(0);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const LanePoint<F>& p = s.points[k];
    const Mask<F> asked = is_asked(point, p, level);
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
    // A folded limb has next to no lever: a thousandth of the trunk's mobility outdoes it.
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
  const F beyond = max(one - num<F>(0.5) / max(errors.worst_over_precision, num<F>(1e-6)),
                       num<F>(0));
  const F help = num<F>(kHelpPerUnitMissing) * errors.worst * beyond * beyond;
  return min(select(help < num<F>(1e-7), num<F>(0), help), one);
}

/// Starts lanes from their reference: places are those of the reference posture.
template <class F>
void begin_lanes(const Plan& plan,
                 const Shape& shape,
                 const SolveSettings& settings,
                 const Mask<F>& mask,
                 Lanes<F>& s,
                 Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F last = num<F>(shape.last_level);
  ground_reference(plan, settings, shape.rows.balance, mask, s);
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  for (LanePoint<F>& p : s.points) p.holds = select(mask, zero, p.holds);
  Progress<F>& p = solve.progress;
  measure_points(plan, s, last);
  F share = one;
  if (!shape.rows.balance) {
    share = help_needed(plan, settings, last, s);
    close_limbs(plan, settings, last, mask & (share < one), s);
    const Errors<F> errors = measure(plan, false, last, s);
    share = max(share, help_missing(errors));
  }
  solve.needs_body = select(mask, select(share > zero, one, zero), solve.needs_body);
  s.mobility = select(mask, share, s.mobility);
  p.iterations = select(mask, zero, p.iterations);
  p.capped = select(mask, zero, p.capped);
  p.steps = select(mask, zero, p.steps);
  p.square = select(mask, zero, p.square);
  p.merit = select(mask, num<F>(1e9), p.merit);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, num<F>(kLeastDamping), p.damping);
  p.homing = select(mask, one, p.homing);
  p.level = select(mask, last, p.level);
  solve.by_level = select(mask, zero, solve.by_level);
  solve.held_error = select(mask, num<F>(1e9), solve.held_error);
  const Mask<F> loops = mask & (share > zero);
  if (any(loops)) {
    // Where no step is any good, what limbs did alone is the answer.
    for (const int j : plan.live) {
      const auto i = static_cast<std::size_t>(j);
      s.best_rotation[i] = select(loops, s.rotation[i], s.best_rotation[i]);
      s.best_place[i] = select(loops, s.place[i], s.best_place[i]);
    }
    take_posture(s.reference_rotation, s.reference_place, plan, loops, s);
    static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  }
}

/// Closes a level: what it reached is held from now on, and the next begins from there.
template <class F>
void next_level(const Plan& plan,
                const Shape& shape,
                const Mask<F>& mask,
                Lanes<F>& s,
                Solve<F>& solve) {
  Progress<F>& p = solve.progress;
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const F level = num<F>(plan.points[k].level);
    LanePoint<F>& point = s.points[k];
    const Mask<F> held =
        mask & (level > num<F>(0)) & (level <= p.level) & (point.holds < num<F>(0.5));
    point.held = select(held, point.place, point.held);
    point.holds = select(held, num<F>(1), point.holds);
  }
  p.level = select(mask, p.level + num<F>(1), p.level);
  const Errors<F> errors = measure(plan, shape.rows.balance, p.level, s);
  // Doing nothing for the next level is the first answer.
  p.merit = select(mask, sqrt(errors.square), p.merit);
  p.square = select(mask, errors.square, p.square);
  solve.held_error = select(mask, errors.held + num<F>(kHeldSlack), solve.held_error);
  p.stalled = select(mask, num<F>(0), p.stalled);
  p.damping = select(mask, num<F>(kLeastDamping), p.damping);
  p.homing = select(mask, num<F>(0), p.homing);
  s.mobility = select(mask, num<F>(1), s.mobility);
}

/// All levels at once could not be met: from the reference again, one after the other.
template <class F>
void begin_levels(const Plan& plan,
                  const Shape& shape,
                  const Mask<F>& mask,
                  Lanes<F>& s,
                  Solve<F>& solve) {
  const F one = num<F>(1);
  Progress<F>& p = solve.progress;
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  solve.by_level = select(mask, one, solve.by_level);
  p.level = select(mask, one, p.level);
  p.steps = select(mask, num<F>(0), p.steps);
  p.merit = select(mask, num<F>(1e9), p.merit);
  p.stalled = select(mask, num<F>(0), p.stalled);
  p.damping = select(mask, num<F>(kLeastDamping), p.damping);
  p.homing = select(mask, one, p.homing);
  static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
}

/// One turn of the loop for all lanes; those of the answer are done.
template <class F>
[[nodiscard]] Mask<F> advance_lanes(const Plan& plan,
                                    const Shape& shape,
                                    const SolveSettings& settings,
                                    Lanes<F>& s,
                                    Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Progress<F>& p = solve.progress;
  const bool balance = shape.rows.balance;
  const Mask<F> was_homing = p.homing > zero;
  step_whole_body(plan, shape.rows, p, s);
  spare_hamstrings(plan, settings, zero < one, s);
  p.iterations = p.iterations + one;
  p.steps = p.steps + one;
  const int homing_steps = balance ? kHomingStepsBalanced : kHomingSteps;
  const F fades = num<F>(balance ? kHomingFades : 1.0);
  p.homing = select(p.steps < num<F>(homing_steps), fades * p.homing, zero);
  const Mask<F> closes = p.homing <= zero;
  if (any(closes)) {
    // On a trunk that hardly moved limbs do what they would do alone.
    const Mask<F> first = closes & was_homing;
    if (!balance && any(first)) rest_limbs(plan, p.level, first, s);
    measure_points(plan, s, p.level);
    SolveSettings told = settings;
    told.mixes = false;
    close_limbs(plan, told, p.level, closes, s);
  }
  const Errors<F> errors = measure(plan, balance, p.level, s);

  const F merit = sqrt(errors.square) + num<F>(4) * errors.balance;
  const Mask<F> homes = p.homing > zero;
  const Mask<F> met = (errors.worst_over_precision <= one) &
                      (errors.balance <= s.balance_precision) &
                      (errors.held <= solve.held_error);
  // Of postures that are all good enough the last counts.
  const Mask<F> better =
      (met | ((merit < p.merit) & (errors.held <= solve.held_error))) & !homes;
  const F gain = p.merit - merit;
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.best_rotation[i] = select(better, s.rotation[i], s.best_rotation[i]);
    s.best_place[i] = select(better, s.place[i], s.best_place[i]);
  }
  p.merit = select(better, merit, p.merit);
  p.square = select(better | homes, errors.square, p.square);
  // A step that made things worse is taken back and tried again, more carefully; not
  // while steps home: those may cost a little at first.
  const Mask<F> worse = !(better | homes);
  if (any(worse)) {
    take_posture(s.best_rotation, s.best_place, plan, worse, s);
    static_cast<void>(measure(plan, balance, p.level, s));
  }
  p.damping = select(worse, num<F>(8) * p.damping, p.damping);
  const Mask<F> idle = gain < max(s.threshold, num<F>(0.002) * p.merit);
  p.stalled = select(idle & !homes, p.stalled + one, zero);
  // Homing is never cut short: a posture on its way is nobody's answer.
  const Mask<F> capped = (p.iterations >= num<F>(settings.max_iterations)) & !homes;
  const Mask<F> is_done = (met & !homes) | (p.stalled > num<F>(kStalledSteps));
  const F levels = num<F>(shape.last_level);
  const Mask<F> has_levels = levels > one;
  const Mask<F> wants_split =
      has_levels & (solve.by_level < num<F>(shape.by_level ? 0.5 : -1.0)) & !met;
  const Mask<F> wants_next =
      has_levels & (solve.by_level > num<F>(0.5)) & (p.level < levels);
  const Mask<F> splits = is_done & !capped & wants_split;
  const Mask<F> next = is_done & !capped & wants_next;
  const Mask<F> cut = capped & ((!is_done) | wants_split | wants_next);
  p.capped = select(cut, one, zero);
  if (any(next)) next_level(plan, shape, next, s, solve);
  if (any(splits)) begin_levels(plan, shape, splits, s, solve);
  return (is_done | capped) & !(next | splits);
}

/// Brings the centre of mass where it has to be, for supports alone: constraints that
/// cannot be reached must not take balance away. Lanes in balance stay as they are.
template <class F>
void settle_balance(const Plan& plan,
                    const Shape& shape,
                    const SolveSettings& settings,
                    const Mask<F>& mask,
                    Lanes<F>& s) {
  const F zero = num<F>(0);
  Progress<F> alone{};
  alone.damping = num<F>(kLeastDamping);
  const F mobility = s.mobility;
  for (int round = 0; round < kBalanceSteps; ++round) {
    const Errors<F> errors = measure(plan, true, zero, s);
    const Mask<F> off = mask & (errors.balance > s.balance_precision);
    if (!any(off)) break;
    for (const int j : plan.live) {
      const auto i = static_cast<std::size_t>(j);
      s.kept_rotation[i] = s.rotation[i];
      s.kept_place[i] = s.place[i];
    }
    s.mobility = num<F>(1);
    step_whole_body(plan, shape.rows, alone, s);
    measure_points(plan, s, zero);
    close_limbs(plan, settings, zero, off, s);
    take_posture(s.kept_rotation, s.kept_place, plan, !off, s);
    s.mobility = mobility;
  }
}

/// The final posture of lanes that are done. Leaves its measures.
template <class F>
[[nodiscard]] Errors<F> finish_lanes(const Plan& plan,
                                     const Shape& shape,
                                     const SolveSettings& settings,
                                     const Mask<F>& mask,
                                     Lanes<F>& s,
                                     Solve<F>& solve) {
  const F last = num<F>(shape.last_level);
  const Mask<F> looped = mask & (solve.needs_body > num<F>(0));
  take_posture(s.best_rotation, s.best_place, plan, looped, s);
  if (any(looped)) {
    // A second time: the first left single precision's error in the bend of a limb that
    // went far.
    measure_points(plan, s, last);
    SolveSettings told = settings;
    told.mixes = false;
    close_limbs(plan, told, last, looped, s);
    if (shape.rows.balance) settle_balance(plan, shape, settings, looped, s);
  }
  for (LanePoint<F>& p : s.points) p.holds = select(mask, num<F>(0), p.holds);
  return measure(plan, shape.rows.balance, last, s);
}

}  // namespace marey::retarget
