// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_solve.h"
#include "retarget/adapt/kernel/thesis_kinetics.h"

/// The thesis' method (Kulpa 2005, chapters 4 and 5), over lanes: groups from light to
/// heavy towards the constraints, then root, then ground.
///
/// The loop of the thesis begins with the limbs and ends with the ground; here each
/// iteration begins after the limbs and ends with them. The adaptations and their order
/// are the same, but errors are measured when limbs are closed. An iteration for which
/// limbs suffice counts as one, and the returned posture has closed limbs.
namespace marey::retarget {

/// Structures of the loop in addition to the plan.
struct ThesisShape {
  ThesisPlan groups;
  bool balance = false;
};

/// Maximum number of consecutive retries. A step that increased the error is reverted and
/// repeated with half of its rotations; after the last retry the best posture is final.
/// The step size grows again after an improvement.
inline constexpr double kMaxRetries = 3;

template <class F>
[[nodiscard]] Errors<F> measure_targets(const Plan& plan, bool balance, Lanes<F>& s) {
  const F zero = num<F>(0);
  Errors<F> out{zero, zero, zero, zero, zero, zero};
  F weights = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const LanePoint<F>& p = s.points[k];
    measure_target(plan, static_cast<int>(k), s);
    const F error = length(p.error);
    const F counts =
        select(is_served(point, p, num<F>(kAllLevels)), p.per_precision, zero);
    out.worst_over_precision = max(out.worst_over_precision, error * counts);
    if (!point.direct) out.worst = max(out.worst, error);
    const bool support = point.goal == GoalKind::kSupport;
    const F weight = select(
        (p.active > zero) & (num<F>(support ? 1 : 0) < num<F>(0.5)), p.weight, zero);
    out.mean = out.mean + weight * error;
    out.square = out.square + weight * error * error;
    weights = weights + weight;
  }
  out.mean = out.mean / max(weights, num<F>(1e-6));
  out.square = out.square / max(weights, num<F>(1e-6));
  if (balance) {
    measure_balance(plan, s);
    out.balance = length(balance_error(s));
  }
  return out;
}

/// Returns the merit of a posture: errors of constraints plus twice the balance error
/// beyond its precision (CnErrorMax).
template <class F>
[[nodiscard]] F merit_of(const Errors<F>& errors, const Lanes<F>& s) {
  return errors.mean + num<F>(2) * max(errors.balance - s.balance_precision, num<F>(0));
}

/// Activates the targets up to `level`, in the lanes of `mask`.
template <class F>
void activate_levels(const Plan& plan, const Mask<F>& mask, const F& level, Lanes<F>& s) {
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<F>& point = s.points[k];
    const Mask<F> now = num<F>(plan.points[k].level) <= level;
    point.active = select(mask, select(now, point.requested, num<F>(0)), point.active);
  }
}

/// Returns true, per lane, if a posture does not increase the errors of finished levels.
/// Precondition: `errors` belong to the posture.
template <class F>
[[nodiscard]] Mask<F> keeps_levels(const Plan& plan,
                                   const Errors<F>& errors,
                                   const Lanes<F>& s,
                                   const Solve<F>& solve) {
  Mask<F> out = errors.balance <= solve.held_balance;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const LanePoint<F>& point = s.points[k];
    const Mask<F> free = point.holds < num<F>(0.5);
    out = out & (free | (length(point.error) <= point.held.x + num<F>(kHeldSlack)));
  }
  return out;
}

/// Closes the limbs. With balance, corrects the displacement of the centre of mass by the
/// root and closes the limbs again; each round leaves about a tenth of the error.
template <class F>
[[nodiscard]] Errors<F> close_and_settle(const Plan& plan,
                                         const ThesisShape& shape,
                                         const SolveSettings& settings,
                                         int rounds,
                                         const Mask<F>& mask,
                                         Lanes<F>& s) {
  const F one = num<F>(1);
  adapt_groups(plan, shape.groups, false, settings, one, mask, s);
  Errors<F> errors = measure_targets(plan, shape.balance, s);
  if (!shape.balance) return errors;
  for (int round = 0; round < rounds; ++round) {
    const Mask<F> off = mask & is_unbalanced(s);
    if (!any(off)) break;
    balance_with_root(plan, settings, all_of_root(s), off, s);
    adapt_groups(plan, shape.groups, false, settings, one, off, s);
    errors = measure_targets(plan, shape.balance, s);
  }
  return errors;
}

/// In the thesis, priority ("the more important first, never undone by the next") applies
/// to each segment separately (4.2.2.1), while the root uses a mean of all targets and
/// the loop the sum of their errors. Here each level has its own complete loop: the first
/// without the others, the next with steps that do not increase the errors of finished
/// levels beyond their precision.
///
/// Starts the next level of lanes in `mask` that have one, from their best posture.
template <class F>
void next_thesis_level(const Plan& plan,
                       const ThesisShape& shape,
                       const SolveSettings& settings,
                       const Mask<F>& mask,
                       Lanes<F>& s,
                       Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Progress<F>& p = solve.progress;
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  Errors<F> errors = measure_targets(plan, shape.balance, s);
  const Mask<F> off =
      mask & (solve.holds < num<F>(0.5)) & (errors.balance > s.balance_precision);
  if (shape.balance && any(off)) {
    errors = close_and_settle(plan, shape, settings, 8, off, s);
  }
  keep_as_best(plan, mask, s);
  F next = num<F>(kAllLevels);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const F level = num<F>(plan.points[k].level);
    LanePoint<F>& point = s.points[k];
    const F allowed = max(length(point.error), one / point.per_precision);
    const Mask<F> holds = mask & (level <= p.level) & (point.holds < num<F>(0.5));
    point.held.x = select(holds, allowed, point.held.x);
    point.holds = select(holds, one, point.holds);
    const Mask<F> comes = (point.requested > zero) & (level > p.level);
    next = select(comes, min(next, level), next);
  }
  p.level = select(mask, next, p.level);
  activate_levels(plan, mask, p.level, s);
  solve.holds = select(mask, one, solve.holds);
  solve.held_balance =
      select(mask, max(errors.balance, s.balance_precision), solve.held_balance);
  errors = measure_targets(plan, shape.balance, s);
  const Mask<F> requested = mask & (errors.worst_over_precision > one);
  p.iterations = select(requested, max(p.iterations, one), p.iterations);
  errors = close_and_settle(plan, shape, settings, 8, requested, s);
  const Mask<F> lost = mask & !keeps_levels(plan, errors, s, solve);
  if (any(lost)) {
    take_posture(s.best_rotation, s.best_place, plan, lost, s);
    errors = measure_targets(plan, shape.balance, s);
  }
  keep_as_best(plan, mask, s);
  const Mask<F> met =
      (errors.worst_over_precision <= one) & (errors.balance <= s.balance_precision);
  solve.needs_body = select(mask, select(met, zero, one), solve.needs_body);
  solve.begun = select(mask, p.iterations, solve.begun);
  p.merit = select(mask, merit_of(errors, s), p.merit);
  p.square = select(mask, errors.balance, p.square);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, one, p.damping);
}

/// Advances lanes of `mask` whose level is done (no body movement needed) to the next
/// level with errors, or to the end.
template <class F>
void skip_met_levels(const Plan& plan,
                     const ThesisShape& shape,
                     const SolveSettings& settings,
                     const Mask<F>& mask,
                     Lanes<F>& s,
                     Solve<F>& solve) {
  for (int n = 0; n < plan.level_count; ++n) {
    const Mask<F> next = mask & (solve.needs_body <= num<F>(0)) &
                         (solve.progress.level < solve.last_level);
    if (!any(next)) return;
    next_thesis_level(plan, shape, settings, next, s, solve);
  }
}

/// Starts lanes from their reference, on the ground and with closed limbs: the first half
/// of the thesis' iteration.
template <class F>
void begin_thesis(const Plan& plan,
                  const ThesisShape& shape,
                  const SolveSettings& settings,
                  const Mask<F>& mask,
                  Lanes<F>& s,
                  Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  ground_reference(plan, settings, shape.balance, mask, s);
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  Progress<F>& p = solve.progress;
  F first = num<F>(settings.blend ? kAllLevels : plan.level_count);
  F last = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<F>& point = s.points[k];
    point.requested = select(mask, point.active, point.requested);
    point.holds = select(mask, zero, point.holds);
    const F level = num<F>(plan.points[k].level);
    const Mask<F> counts = (point.active > zero) & (level > zero);
    first = select(counts, min(first, level), first);
    last = select(counts, max(last, level), last);
  }
  if (settings.blend) first = num<F>(kAllLevels);
  p.level = select(mask, first, p.level);
  solve.last_level = select(mask, last, solve.last_level);
  solve.holds = select(mask, zero, solve.holds);
  solve.begun = select(mask, zero, solve.begun);
  solve.held_balance = select(mask, num<F>(1e9), solve.held_balance);
  activate_levels(plan, mask, p.level, s);
  const Errors<F> before = measure_targets(plan, shape.balance, s);
  // Without errors the reference is the result.
  const Mask<F> idle = (before.worst <= num<F>(kOnFootprint)) &
                       (before.worst_over_precision <= one) &
                       (before.balance <= s.balance_precision);
  const Mask<F> requested = mask & !idle;
  if (any(requested))
    adapt_groups(plan, shape.groups, false, settings, one, requested, s);
  const Errors<F> errors = measure_targets(plan, shape.balance, s);
  keep_as_best(plan, mask, s);
  const Mask<F> met =
      (errors.worst_over_precision <= one) & (errors.balance <= s.balance_precision);
  solve.needs_body = select(mask, select(idle | met, zero, one), solve.needs_body);
  p.iterations = select(mask, select(idle, zero, one), p.iterations);
  p.capped = select(mask, zero, p.capped);
  p.merit = select(mask, merit_of(errors, s), p.merit);
  p.square = select(mask, errors.balance, p.square);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, one, p.damping);
  skip_met_levels(plan, shape, settings, mask, s, solve);
}

/// Runs one iteration of the merged loop (5.3.3) for all lanes. Returns the lanes that
/// are done.
template <class F>
[[nodiscard]] Mask<F> advance_thesis(const Plan& plan,
                                     const ThesisShape& shape,
                                     const SolveSettings& settings,
                                     Lanes<F>& s,
                                     Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  Progress<F>& p = solve.progress;
  const F cap = num<F>(settings.max_iterations);
  const Mask<F> mask = (solve.needs_body > zero) & (p.iterations - solve.begun < cap);
  if (!any(mask)) return !mask;
  adapt_groups(plan, shape.groups, true, settings, p.damping, mask, s);
  const Vec3<F> error = mean_root_error(plan, shape.groups, s);
  shift_root(plan, select(mask, p.damping * error, Vec3<F>{zero, zero, zero}), s);
  adapt_to_supports(plan, settings, mask, s);
  if (shape.balance) adapt_balance(plan, shape.groups, settings, mask, s);
  Errors<F> errors = close_and_settle(plan, shape, settings, 2, mask, s);
  // Held targets are also held with balance, to its precision.
  const Mask<F> off =
      mask & (solve.holds > num<F>(0.5)) & (errors.balance > solve.held_balance);
  if (any(off)) errors = close_and_settle(plan, shape, settings, 6, off, s);

  p.iterations = select(mask, p.iterations + one, p.iterations);
  const F merit = merit_of(errors, s);
  const Mask<F> better = mask & (merit < p.merit) & keeps_levels(plan, errors, s, solve);
  const Mask<F> worse = mask & !better;
  const F gain = p.merit - merit;
  keep_as_best(plan, better, s);
  const Mask<F> balanced = errors.balance <= s.balance_precision;
  const Mask<F> settled =
      (gain < s.threshold) &
      (balanced | (abs(p.square - errors.balance) < s.balance_threshold));
  p.merit = select(better, merit, p.merit);
  p.square = select(better, errors.balance, p.square);
  if (any(worse)) take_posture(s.best_rotation, s.best_place, plan, worse, s);
  p.stalled = select(worse, p.stalled + one, select(better, zero, p.stalled));
  p.damping = select(worse,
                     num<F>(0.5) * p.damping,
                     select(better, min(one, num<F>(1.5) * p.damping), p.damping));
  const Mask<F> met = (errors.worst_over_precision <= one) & balanced;
  const Mask<F> done =
      mask & ((better & (met | settled)) | (p.stalled > num<F>(kMaxRetries - 0.5)));
  const Mask<F> capped = mask & (p.iterations - solve.begun >= cap);
  p.capped = select(capped & !done, one, p.capped);
  solve.needs_body = select(done | capped, zero, solve.needs_body);
  skip_met_levels(plan, shape, settings, done | capped, s, solve);
  return solve.needs_body <= zero;
}

/// Computes the final posture of lanes that are done; balance is applied last. Measures
/// it.
template <class F>
[[nodiscard]] Errors<F> finish_thesis(const Plan& plan,
                                      const ThesisShape& shape,
                                      const SolveSettings& settings,
                                      const Mask<F>& mask,
                                      Lanes<F>& s,
                                      const Solve<F>& solve) {
  activate_levels(plan, mask, num<F>(kAllLevels), s);
  for (LanePoint<F>& p : s.points) p.holds = select(mask, num<F>(0), p.holds);
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  Errors<F> errors = measure_targets(plan, shape.balance, s);
  const Mask<F> off =
      mask & (solve.holds < num<F>(0.5)) & (errors.balance > s.balance_precision);
  if (shape.balance && any(off)) {
    errors = close_and_settle(plan, shape, settings, 8, off, s);
  }
  return errors;
}

}  // namespace marey::retarget
