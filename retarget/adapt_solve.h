// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_help.h"

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
/// With balance limbs and the root alone come first, too: the root moves by what the
/// limbs' wishes take of balance. The trunk begins with kBalancedMobility at most, which
/// grows with every step that leaves something missing: a posture far from the reference
/// is what is taken last. No loop ends before the trunk has its full mobility. Only a
/// centre of mass that is sent elsewhere has the whole body lean at once.
///
/// All levels of importance are tried at once. Where that does not meet every wish, and
/// importance is priority, the last is left out and the others are tried from the
/// reference again, until all that are left are met or one level is left: to the bit what
/// would come out if the less important were not there. What was reached is held, and the
/// levels that were left out get what they can, one after the other: a step that takes
/// some of it away does not count. Supports come before the centre of mass, and that
/// before constraints.
namespace marey::retarget {

/// These two are promised to callers (retarget/adapter.h).
inline constexpr int kHomingSteps = 4;
/// With balance fewer, that end more gently: the centre of mass has to be met, too.
inline constexpr int kHomingStepsBalanced = 3;
inline constexpr double kHomingFades = 0.5;
/// The third step in a row that hardly helps ends the loop.
inline constexpr double kStalledSteps = 2.5;
/// The trunk's mobility with balance, at first. It grows with every step that leaves
/// something missing: what a turned trunk is not needed for does without. A smaller
/// value keeps postures nearer, but arms straighten further before they are relieved, so
/// that elbows open faster (both figures: docs/measurements.md).
inline constexpr double kBalancedMobility = 0.0295;
/// Mobility per help that is needed, up to there: an arm is relieved before it is
/// straight.
inline constexpr double kHelpBalanced = 0.5;
inline constexpr double kMobilityGrows = 2.0;
inline constexpr double kMobilityGrowsBy = 0.02;

/// Starts lanes of `mask` from their reference, for wishes up to `level`: as if there
/// were no others. Those that need the whole body are told, and measured if there are
/// any; limbs were enough for the rest.
template <class F>
[[nodiscard]] Mask<F> start_from_reference(const Plan& plan,
                                           const Shape& shape,
                                           const SolveSettings& settings,
                                           const F& level,
                                           const Mask<F>& mask,
                                           Lanes<F>& s,
                                           Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  Progress<F>& p = solve.progress;
  measure_points(plan, s, level);
  F share = one;
  Errors<F> errors{};
  if (shape.rows.balance) {
    // A centre of mass that is sent elsewhere has the whole body lean.
    const F leans = fade_between(s.com_travel, kNearTravel, kFarTravel);
    const Mask<F> tries = mask & (leans < one);
    if (any(tries)) share = balance_by_root(plan, settings, level, tries, errors, s);
    share = min(num<F>(kHelpBalanced) * share, num<F>(kBalancedMobility));
    share = select(leans < one, share + leans * (one - share), one);
  } else {
    share = help_needed(plan, settings, true, level, s);
    close_limbs(plan, settings, level, mask & (share < one), s);
    errors = measure(plan, false, level, s);
    share = max(share, help_missing(errors));
  }
  s.mobility = select(mask, share, s.mobility);
  p.steps = select(mask, zero, p.steps);
  p.square = select(mask, zero, p.square);
  p.merit = select(mask, num<F>(1e9), p.merit);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, num<F>(kLeastDamping), p.damping);
  p.homing = select(mask, one, p.homing);
  p.level = select(mask, level, p.level);
  Mask<F> loops = mask & (share > zero);
  Mask<F> homes = loops;
  if (shape.rows.balance) {
    // Limbs and root did it but for what the root's own way changed: steps from there.
    const Mask<F> light = mask & !loops;
    p.merit = select(light, sqrt(errors.square) + num<F>(4) * errors.balance, p.merit);
    p.square = select(light, errors.square, p.square);
    p.homing = select(light, zero, p.homing);
    loops = loops | light;
  }
  if (any(loops)) {
    // Where no step is any good, what limbs did alone is the answer.
    keep_as_best(plan, loops, s);
    take_posture(s.reference_rotation, s.reference_place, plan, homes, s);
    static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  }
  return loops;
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
  ground_reference(plan, settings, shape.rows.balance, mask, s);
  for (LanePoint<F>& p : s.points) p.holds = select(mask, zero, p.holds);
  Progress<F>& p = solve.progress;
  p.capped = select(mask, zero, p.capped);
  p.iterations = select(mask, zero, p.iterations);
  solve.begun = select(mask, zero, solve.begun);
  solve.holds = select(mask, zero, solve.holds);
  solve.held_error = select(mask, num<F>(1e9), solve.held_error);
  solve.held_balance = select(mask, num<F>(1e9), solve.held_balance);
  F last = num<F>(shape.last_level);
  if (shape.last_level > 1.0) last = min(last, asked_level_before(plan, last + one, s));
  solve.last_level = select(mask, last, solve.last_level);
  const Mask<F> loops = start_from_reference(plan, shape, settings, last, mask, s, solve);
  solve.needs_body = select(mask, select(loops, one, zero), solve.needs_body);
}

/// All levels up to a lane's own could not be met at once: without the last of them, from
/// the reference again.
template <class F>
void leave_last_level(const Plan& plan,
                      const Shape& shape,
                      const SolveSettings& settings,
                      const Mask<F>& mask,
                      Lanes<F>& s,
                      Solve<F>& solve) {
  Progress<F>& p = solve.progress;
  solve.begun = select(mask, p.iterations, solve.begun);
  const F level = asked_level_before(plan, p.level, s);
  const Mask<F> loops =
      start_from_reference(plan, shape, settings, level, mask, s, solve);
  const Mask<F> limbs_do = mask & !loops;
  keep_as_best(plan, limbs_do, s);
  if (any(limbs_do)) next_level(plan, shape, settings, limbs_do, s, solve);
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
    if (balance && any(first)) rest_on_root(plan, first, s);
    if (!balance && any(first)) rest_limbs(plan, p.level, first, s);
    measure_points(plan, s, p.level);
    SolveSettings told = settings;
    told.mixes = false;
    if (balance) {
      sink_to_supports(plan, told, closes, s);
      measure_points(plan, s, p.level);
    }
    close_limbs(plan, told, p.level, closes, s);
    if (balance) {
      const F more = num<F>(kMobilityGrows) * s.mobility + num<F>(kMobilityGrowsBy);
      s.mobility = select(closes, min(more, one), s.mobility);
    }
  }
  const Errors<F> errors = measure(plan, balance, p.level, s);

  const F merit = sqrt(errors.square) + num<F>(4) * errors.balance;
  const Mask<F> homes = p.homing > zero;
  const Mask<F> kept =
      (errors.held <= solve.held_error) & (errors.balance <= solve.held_balance);
  const Mask<F> met = (errors.worst_over_precision <= one) &
                      (errors.balance <= s.balance_precision) & kept;
  // Of postures that are all good enough the last counts.
  const Mask<F> better = (met | ((merit < p.merit) & kept)) & !homes;
  const F gain = select(better | homes, p.merit - merit, zero);
  keep_as_best(plan, better, s);
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
  // A step that would help, but not without cost to what is held, may be too long.
  const F counts = select(kept, one, num<F>(0.5));
  // With balance the trunk's mobility still grows until it is the limbs': the next step
  // may help where this one did not.
  Mask<F> stalls = idle & !homes;
  if (balance) stalls = stalls & (s.mobility >= one);
  p.stalled = select(stalls, p.stalled + counts, zero);
  // Homing is never cut short: a posture on its way is nobody's answer.
  const Mask<F> capped =
      (p.iterations - solve.begun >= num<F>(settings.max_iterations)) & !homes;
  const Mask<F> is_done = (met & !homes) | (p.stalled > num<F>(kStalledSteps));
  const Mask<F> ended = is_done | capped;
  p.capped = select(capped & !is_done, one, p.capped);
  if (!shape.by_level || shape.last_level < 2.0) return ended;
  const Mask<F> holds = solve.holds > num<F>(0.5);
  const Mask<F> last = p.level >= solve.last_level;
  const Mask<F> first = p.level <= asked_level_before(plan, p.level, s);
  const Mask<F> leaves = ended & !(met | holds | first);
  const Mask<F> next = ended & !(last | leaves);
  if (any(next)) next_level(plan, shape, settings, next, s, solve);
  if (any(leaves)) leave_last_level(plan, shape, settings, leaves, s, solve);
  return ended & !(next | leaves);
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
  if (any(looped)) finish_level(plan, shape, settings, last, looped, s, solve);
  for (LanePoint<F>& p : s.points) p.holds = select(mask, num<F>(0), p.holds);
  return measure(plan, shape.rows.balance, last, s);
}

}  // namespace marey::retarget
