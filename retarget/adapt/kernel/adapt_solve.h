// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_help.h"

/// The strict method, over lanes.
///
/// 1. Limbs alone: every limb closes on its target analytically. If all targets are
///    within comfortable reach, this is the result (the thesis: the trunk moves only when
///    limbs do not suffice), and no loop runs.
/// 2. The whole body: damped Gauss-Newton steps move the trunk. After each step the limbs
///    close on their targets again, analytically, from their posture in the reference.
///    The first kHomingSteps also rotate every joint back towards the reference, so that
///    the posture is close to the nearest one. Their number is fixed, and each later step
///    is proportional to the remaining error. The result is therefore a continuous
///    function of the targets although the number of steps is not.
/// 3. Between a limb's comfortable reach and kFullHelp the trunk's mobility fades in from
///    0: it starts to help before an arm is straight.
///
/// With balance, limbs and the root alone also come first: the root corrects the change
/// of the centre of mass that the limbs cause. The trunk starts with a mobility of at
/// most kBalancedMobility, which grows with every step that leaves errors, so that
/// postures far from the reference are used last. No loop ends before the trunk has its
/// full mobility. Only if the centre of mass has a target away from the reference does
/// the whole body lean immediately.
///
/// All levels of importance are tried together. If not all targets are met, and
/// importance means priority, the last level is left out and the others are solved from
/// the reference again, until all remaining targets are met or one level is left. The
/// result equals, to the bit, that without the less important targets. It is then held,
/// and the omitted levels are solved in order: a step that increases the error of held
/// targets is rejected. Supports have priority over the centre of mass, and the centre of
/// mass over constraints.
namespace marey::retarget {

/// These two values are documented in retarget/adapt/adapter_options.h as kFirstSteps and
/// kFirstStepsBalanced.
inline constexpr int kHomingSteps = 4;
/// With balance fewer steps, with a gentler end, because the centre of mass must be met
/// as well.
inline constexpr int kHomingStepsBalanced = 3;
inline constexpr double kHomingFades = 0.5;
/// The loop ends at the third consecutive step with negligible improvement.
inline constexpr double kStalledSteps = 2.5;
/// Initial mobility of the trunk with balance. It grows with every step that leaves
/// errors, so that the trunk moves only where necessary. A smaller value keeps postures
/// nearer to the reference, but arms straighten further before the trunk helps, so that
/// elbows extend faster (both values: docs/accuracy/README.md).
inline constexpr double kBalancedMobility = 0.0295;
/// Mobility per unit of needed help, up to kBalancedMobility: the trunk helps before an
/// arm is straight.
inline constexpr double kHelpBalanced = 0.5;
inline constexpr double kMobilityGrows = 2.0;
inline constexpr double kMobilityGrowsBy = 0.02;

/// Starts the lanes of `mask` from their reference for targets up to `level`, without
/// regard to others. Returns the lanes that need the whole body, and measures them if
/// there are any. For all other lanes limbs sufficed.
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
    // The whole body leans if the centre of mass has a target away from the reference.
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
  p.damping = select(mask, num<F>(kMinDamping), p.damping);
  p.homing = select(mask, one, p.homing);
  p.level = select(mask, level, p.level);
  Mask<F> loops = mask & (share > zero);
  Mask<F> homes = loops;
  if (shape.rows.balance) {
    // Limbs and root sufficed except for errors that the root's own movement caused:
    // steps start from there.
    const Mask<F> light = mask & !loops;
    p.merit = select(light, sqrt(errors.square) + num<F>(4) * errors.balance, p.merit);
    p.square = select(light, errors.square, p.square);
    p.homing = select(light, zero, p.homing);
    loops = loops | light;
  }
  if (any(loops)) {
    // If no step is an improvement, the result of the limbs alone is returned.
    keep_as_best(plan, loops, s);
    take_posture(s.reference_rotation, s.reference_place, plan, homes, s);
    static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  }
  return loops;
}

/// Starts lanes from their reference; positions are those of the reference posture.
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
  if (shape.last_level > 1.0)
    last = min(last, requested_level_before(plan, last + one, s));
  solve.last_level = select(mask, last, solve.last_level);
  const Mask<F> loops = start_from_reference(plan, shape, settings, last, mask, s, solve);
  solve.needs_body = select(mask, select(loops, one, zero), solve.needs_body);
}

/// Restarts from the reference without the last level, in lanes whose levels cannot be
/// met together.
template <class F>
void leave_last_level(const Plan& plan,
                      const Shape& shape,
                      const SolveSettings& settings,
                      const Mask<F>& mask,
                      Lanes<F>& s,
                      Solve<F>& solve) {
  Progress<F>& p = solve.progress;
  solve.begun = select(mask, p.iterations, solve.begun);
  const F level = requested_level_before(plan, p.level, s);
  const Mask<F> loops =
      start_from_reference(plan, shape, settings, level, mask, s, solve);
  const Mask<F> limbs_do = mask & !loops;
  keep_as_best(plan, limbs_do, s);
  if (any(limbs_do)) next_level(plan, shape, settings, limbs_do, s, solve);
  static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
}

/// Closes the limbs on their targets again after a step of the whole body, in lanes of
/// `closes`. `first` are those whose homing has just ended.
template <class F>
void close_after_step(const Plan& plan,
                      const SolveSettings& settings,
                      bool balance,
                      const F& level,
                      const Mask<F>& closes,
                      const Mask<F>& first,
                      Lanes<F>& s) {
  // If the trunk hardly moved, limbs move as they would alone.
  if (balance && any(first)) rest_on_root(plan, first, s);
  if (!balance && any(first)) rest_limbs(plan, level, first, s);
  measure_points(plan, s, level);
  SolveSettings unmixed = settings;
  unmixed.mixes = false;
  if (balance) {
    sink_to_supports(plan, unmixed, closes, s);
    measure_points(plan, s, level);
  }
  close_limbs(plan, unmixed, level, closes, s);
  if (balance) {
    const F more = num<F>(kMobilityGrows) * s.mobility + num<F>(kMobilityGrowsBy);
    s.mobility = select(closes, min(more, num<F>(1)), s.mobility);
  }
}

/// Runs one iteration of the loop for all lanes. Returns the lanes that are done.
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
    close_after_step(plan, settings, balance, p.level, closes, closes & was_homing, s);
  }
  const Errors<F> errors = measure(plan, balance, p.level, s);

  const F merit = sqrt(errors.square) + num<F>(4) * errors.balance;
  const Mask<F> homes = p.homing > zero;
  const Mask<F> kept =
      (errors.held <= solve.held_error) & (errors.balance <= solve.held_balance);
  const Mask<F> met = (errors.worst_over_precision <= one) &
                      (errors.balance <= s.balance_precision) & kept;
  // Among postures that are all within precision the last is used.
  const Mask<F> better = (met | ((merit < p.merit) & kept)) & !homes;
  const F gain = select(better | homes, p.merit - merit, zero);
  keep_as_best(plan, better, s);
  p.merit = select(better, merit, p.merit);
  p.square = select(better | homes, errors.square, p.square);
  // A step that increased the error is reverted and repeated with more damping, except
  // during homing, where the error may increase at first.
  const Mask<F> worse = !(better | homes);
  if (any(worse)) {
    take_posture(s.best_rotation, s.best_place, plan, worse, s);
    static_cast<void>(measure(plan, balance, p.level, s));
  }
  p.damping = select(worse, num<F>(8) * p.damping, p.damping);
  const Mask<F> idle = gain < max(s.threshold, num<F>(0.002) * p.merit);
  // A step that reduces the error but violates held targets may be too long.
  const F counts = select(kept, one, num<F>(0.5));
  // With balance the trunk's mobility still grows to that of the limbs, so the next step
  // may improve where this one did not.
  Mask<F> stalls = idle & !homes;
  if (balance) stalls = stalls & (s.mobility >= one);
  p.stalled = select(stalls, p.stalled + counts, zero);
  // Homing is always completed, because intermediate postures are not valid results.
  const Mask<F> capped =
      (p.iterations - solve.begun >= num<F>(settings.max_iterations)) & !homes;
  const Mask<F> is_done = (met & !homes) | (p.stalled > num<F>(kStalledSteps));
  const Mask<F> ended = is_done | capped;
  p.capped = select(capped & !is_done, one, p.capped);
  if (!shape.by_level || shape.last_level < 2.0) return ended;
  const Mask<F> holds = solve.holds > num<F>(0.5);
  const Mask<F> last = p.level >= solve.last_level;
  const Mask<F> first = p.level <= requested_level_before(plan, p.level, s);
  const Mask<F> leaves = ended & !(met | holds | first);
  const Mask<F> next = ended & !(last | leaves);
  if (any(next)) next_level(plan, shape, settings, next, s, solve);
  if (any(leaves)) leave_last_level(plan, shape, settings, leaves, s, solve);
  return ended & !(next | leaves);
}

/// Computes the final posture of lanes that are done, and measures it.
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
