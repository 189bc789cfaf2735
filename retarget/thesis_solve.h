// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_solve.h"
#include "retarget/thesis_kinetics.h"

/// The thesis' method (Kulpa 2005, chapters 4 and 5), over lanes: groups from light to
/// heavy towards the constraints, root, ground.
///
/// The loop of the thesis begins with the limbs and ends with the ground; here each turn
/// begins behind the limbs and ends with them. The adaptations are the same in the same
/// order, but errors are measured when limbs have met what they can: an iteration that
/// limbs suffice for is one, and what is handed out is closed.
namespace marey::retarget {

/// What the loop needs beside the plan.
struct ThesisShape {
  ThesisPlan groups;
  bool balance = false;
};

/// A step that made things worse is taken back and tried with half of its turns; after
/// this many in a row the posture is the best there is. Steps that help grow again.
inline constexpr double kMostRetries = 3;

template <class F>
[[nodiscard]] Errors<F> measure_wishes(const Plan& plan, bool balance, Lanes<F>& s) {
  const F zero = num<F>(0);
  Errors<F> out{zero, zero, zero, zero, zero, zero};
  F weights = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const LanePoint<F>& p = s.points[k];
    measure_wish(plan, static_cast<int>(k), s);
    const F error = length(p.error);
    out.worst_over_precision = max(out.worst_over_precision, error * p.per_precision);
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

/// What a posture is worth: constraints, and twice what balance lacks beyond its
/// precision (CnErrorMax).
template <class F>
[[nodiscard]] F merit_of(const Errors<F>& errors, const Lanes<F>& s) {
  return errors.mean + num<F>(2) * max(errors.balance - s.balance_precision, num<F>(0));
}

/// Limbs, and with balance what their masses undo: the root by what is left, and limbs
/// again. A round leaves about a tenth.
template <class F>
[[nodiscard]] Errors<F> close_and_settle(const Plan& plan,
                                         const ThesisShape& shape,
                                         const SolveSettings& settings,
                                         int rounds,
                                         const Mask<F>& mask,
                                         Lanes<F>& s) {
  const F one = num<F>(1);
  adapt_groups(plan, shape.groups, false, settings, one, mask, s);
  Errors<F> errors = measure_wishes(plan, shape.balance, s);
  if (!shape.balance) return errors;
  for (int round = 0; round < rounds; ++round) {
    const Mask<F> off = mask & is_unbalanced(s);
    if (!any(off)) break;
    balance_with_root(plan, settings, {one, one, one}, off, s);
    adapt_groups(plan, shape.groups, false, settings, one, off, s);
    errors = measure_wishes(plan, shape.balance, s);
  }
  return errors;
}

/// Starts lanes from their reference, on the ground and with their limbs closed: the
/// thesis' first half of an iteration.
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
  const Errors<F> before = measure_wishes(plan, shape.balance, s);
  // Nobody asks: the reference it is.
  const Mask<F> idle = (before.worst <= num<F>(kOnFootprint)) &
                       (before.worst_over_precision <= one) &
                       (before.balance <= s.balance_precision);
  const Mask<F> asked = mask & !idle;
  if (any(asked)) adapt_groups(plan, shape.groups, false, settings, one, asked, s);
  const Errors<F> errors = measure_wishes(plan, shape.balance, s);
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.best_rotation[i] = select(mask, s.rotation[i], s.best_rotation[i]);
    s.best_place[i] = select(mask, s.place[i], s.best_place[i]);
  }
  const Mask<F> met =
      (errors.worst_over_precision <= one) & (errors.balance <= s.balance_precision);
  solve.needs_body = select(mask, select(idle | met, zero, one), solve.needs_body);
  p.iterations = select(mask, select(idle, zero, one), p.iterations);
  p.capped = select(mask, zero, p.capped);
  p.merit = select(mask, merit_of(errors, s), p.merit);
  p.square = select(mask, errors.balance, p.square);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, one, p.damping);
}

/// One turn of the merged loop (5.3.3) for all lanes; those of the answer are done.
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
  const Mask<F> mask = (solve.needs_body > zero) & (p.iterations < cap);
  p.capped = select((solve.needs_body > zero) & !mask, one, p.capped);
  if (!any(mask)) return !mask;
  adapt_groups(plan, shape.groups, true, settings, p.damping, mask, s);
  const Vec3<F> wish = root_wish(plan, shape.groups, s);
  shift_root(plan, select(mask, p.damping * wish, Vec3<F>{zero, zero, zero}), s);
  adapt_to_supports(plan, settings, mask, s);
  if (shape.balance) adapt_balance(plan, shape.groups, settings, mask, s);
  const Errors<F> errors = close_and_settle(plan, shape, settings, 2, mask, s);

  p.iterations = select(mask, p.iterations + one, p.iterations);
  const F merit = merit_of(errors, s);
  const Mask<F> better = mask & (merit < p.merit);
  const Mask<F> worse = mask & !better;
  const F gain = p.merit - merit;
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.best_rotation[i] = select(better, s.rotation[i], s.best_rotation[i]);
    s.best_place[i] = select(better, s.place[i], s.best_place[i]);
  }
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
      mask & ((better & (met | settled)) | (p.stalled > num<F>(kMostRetries - 0.5)));
  solve.needs_body = select(done, zero, solve.needs_body);
  const Mask<F> left = solve.needs_body > zero;
  p.capped = select(left & (p.iterations >= cap), one, p.capped);
  return !(left & (p.iterations < cap));
}

/// The final posture of lanes that are done: balance has the last word. Leaves its
/// measures.
template <class F>
[[nodiscard]] Errors<F> finish_thesis(const Plan& plan,
                                      const ThesisShape& shape,
                                      const SolveSettings& settings,
                                      const Mask<F>& mask,
                                      Lanes<F>& s) {
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  Errors<F> errors = measure_wishes(plan, shape.balance, s);
  const Mask<F> off = mask & (errors.balance > s.balance_precision);
  if (shape.balance && any(off)) {
    errors = close_and_settle(plan, shape, settings, 8, off, s);
  }
  return errors;
}

}  // namespace marey::retarget
