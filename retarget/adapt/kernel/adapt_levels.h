// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/settle_balance.h"

/// Levels of importance of the strict method, over lanes: selects the levels to solve,
/// and holds the result of one level while the next is solved.
namespace marey::retarget {

/// Permitted movement of held points, in units: rounding errors.
inline constexpr double kHeldSlack = 2e-5;
/// State of a solve between iterations of its loop.
template <class F>
struct Solve {
  Progress<F> progress;
  F needs_body{};    ///< 0: limbs sufficed.
  F held_error{};    ///< Error of held points at the end of their level,
  F held_balance{};  ///< and of the centre of mass.
  F begun{};         ///< Iterations done when the level began.
  F holds{};         ///< 1: at least one level is done and held.
  F last_level{};    ///< Last level with active targets.
};

/// Properties of a plan that the strict method uses.
struct Shape {
  RowOrder rows;
  double last_level = 1.0;  ///< Lowest level of importance; 1 is the highest.
  bool by_level = true;     ///< Control::kPriority.
};

/// Stores the current posture as the best so far, in the lanes of `mask`.
template <class F>
void keep_as_best(const Plan& plan, const Mask<F>& mask, Lanes<F>& s) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.best_rotation[i] = select(mask, s.rotation[i], s.best_rotation[i]);
    s.best_place[i] = select(mask, s.place[i], s.best_place[i]);
  }
}

/// Returns the last level before `level` with active targets; `level` if there is none.
template <class F>
[[nodiscard]] F requested_level_before(const Plan& plan,
                                       const F& level,
                                       const Lanes<F>& s) {
  F out = num<F>(0);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const F own = num<F>(plan.points[k].level);
    const Mask<F> takes = (s.points[k].active > num<F>(0)) & (own < level);
    out = select(takes, max(out, own), out);
  }
  return select(out < num<F>(1), level, out);
}

/// Returns the first level after `level` with active targets. Precondition: there is one.
template <class F>
[[nodiscard]] F requested_level_after(const Plan& plan,
                                      const F& level,
                                      const Lanes<F>& s) {
  F out = num<F>(1e6);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const F own = num<F>(plan.points[k].level);
    const Mask<F> takes = (s.points[k].active > num<F>(0)) & (own > level);
    out = select(takes, min(out, own), out);
  }
  return out;
}

/// Finishes a level that needed the whole body, in the lanes of `mask`. Starting from its
/// best posture, closes the limbs a second time (after the first, a limb that moved far
/// still has single-precision error in its bend), and settles balance if the level is the
/// first. Reverts changes that increase the error of a higher level.
template <class F>
void finish_level(const Plan& plan,
                  const Shape& shape,
                  const SolveSettings& settings,
                  const F& level,
                  const Mask<F>& mask,
                  Lanes<F>& s,
                  const Solve<F>& solve) {
  const bool balance = shape.rows.balance;
  take_posture(s.best_rotation, s.best_place, plan, mask, s);
  measure_points(plan, s, level);
  SolveSettings unmixed = settings;
  unmixed.mixes = false;
  close_limbs(plan, unmixed, level, mask, s);
  const Mask<F> holds = mask & (solve.holds > num<F>(0.5));
  if (balance) settle_balance(plan, shape.rows, settings, mask & !holds, s);
  if (!any(holds)) return;
  const Errors<F> errors = measure(plan, balance, level, s);
  const Mask<F> lost =
      holds & ((errors.held > solve.held_error) | (errors.balance > solve.held_balance));
  take_posture(s.best_rotation, s.best_place, plan, lost, s);
}

/// Returns the state of a target to hold: its position; a distance within the body; the
/// rotation of an orientation.
template <class F>
void hold_point(const PointPlan& point,
                const Mask<F>& mask,
                const Lanes<F>& s,
                LanePoint<F>& p) {
  Vec3<F> held = p.place;
  if (point.turns_only()) held = p.error;
  if (point.goal == GoalKind::kDistanceToOther) {
    held.x = length(p.place - other_place(point, p, s));
  }
  p.held = select(mask, held, p.held);
  p.holds = select(mask, num<F>(1), p.holds);
}

/// Closes a level: holds its result from now on, and starts the next level there.
template <class F>
void next_level(const Plan& plan,
                const Shape& shape,
                const SolveSettings& settings,
                const Mask<F>& mask,
                Lanes<F>& s,
                Solve<F>& solve) {
  Progress<F>& p = solve.progress;
  finish_level(plan, shape, settings, p.level, mask, s, solve);
  keep_as_best(plan, mask, s);
  static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const F level = num<F>(plan.points[k].level);
    LanePoint<F>& point = s.points[k];
    const Mask<F> held =
        mask & (level > num<F>(0)) & (level <= p.level) & (point.holds < num<F>(0.5));
    hold_point(plan.points[k], held, s, point);
  }
  p.level = select(mask, requested_level_after(plan, p.level, s), p.level);
  const Errors<F> errors = measure(plan, shape.rows.balance, p.level, s);
  // The first candidate for the next level is the unchanged posture.
  p.merit = select(mask, sqrt(errors.square) + num<F>(4) * errors.balance, p.merit);
  p.square = select(mask, errors.square, p.square);
  solve.held_error = select(mask, errors.held + num<F>(kHeldSlack), solve.held_error);
  solve.held_balance =
      select(mask, max(errors.balance, s.balance_precision), solve.held_balance);
  solve.holds = select(mask, num<F>(1), solve.holds);
  solve.begun = select(mask, p.iterations, solve.begun);
  p.stalled = select(mask, num<F>(0), p.stalled);
  p.damping = select(mask, num<F>(kMinDamping), p.damping);
  p.homing = select(mask, num<F>(0), p.homing);
  s.mobility = select(mask, num<F>(1), s.mobility);
}

}  // namespace marey::retarget
