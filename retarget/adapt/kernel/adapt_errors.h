// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/close_limbs.h"

namespace marey::retarget {

/// Errors of the active targets, in units.
template <class F>
struct Errors {
  F worst_over_precision;
  F worst;
  F mean;     ///< Weighted (eq. 4.2); used by the thesis' method only.
  F square;   ///< Weighted mean of squares, used by the strict method, supports included.
  F balance;  ///< Error of the centre of mass.
  F held;     ///< Largest error of supports and of points held for higher levels.
};

/// Measures positions, targets and errors of all targets in every lane, and with
/// `balance` the centre of mass. Targets beyond `level` do not contribute.
template <class F>
[[nodiscard]] Errors<F> measure(const Plan& plan,
                                bool balance,
                                const F& level,
                                Lanes<F>& s) {
  const F zero = num<F>(0);
  measure_points(plan, s, level);
  Errors<F> out{zero, zero, zero, zero, zero, zero};
  F weights = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const LanePoint<F>& p = s.points[k];
    const F error = length(p.error);
    const Mask<F> requested = is_requested(point, p, level);
    const Mask<F> held =
        requested & ((p.holds > zero) | (num<F>(point.level) < num<F>(1)));
    const F counts = select(is_served(point, p, level), p.per_precision, zero);
    out.worst_over_precision = max(out.worst_over_precision, error * counts);
    out.worst = max(out.worst, error);
    out.held = select(held, max(out.held, error), out.held);
    const F weight = select(requested, p.weight, zero);
    out.square = out.square + weight * error * error;
    weights = weights + weight;
  }
  out.square = out.square * (num<F>(1) / max(weights, num<F>(1e-6)));
  if (balance) {
    measure_balance(plan, s);
    out.balance = length(balance_error(s));
  }
  return out;
}

}  // namespace marey::retarget
