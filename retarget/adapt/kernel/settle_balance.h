// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_errors.h"
#include "retarget/adapt/kernel/close_limbs.h"
#include "retarget/adapt/kernel/whole_body_solve.h"

namespace marey::retarget {

/// Steps for supports and balance alone, after constraints moved the centre of mass.
inline constexpr int kBalanceSteps = 10;

/// Sets live joints to `rotation` and `place`, in the lanes of `mask`.
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

/// Moves the centre of mass to its target with supports as the only other targets,
/// because unreachable constraints must not affect balance. Lanes that are in balance are
/// unchanged.
template <class F>
void settle_balance(const Plan& plan,
                    const RowOrder& rows,
                    const SolveSettings& settings,
                    const Mask<F>& mask,
                    Lanes<F>& s) {
  const F zero = num<F>(0);
  Progress<F> alone{};
  alone.damping = num<F>(kMinDamping);
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
    step_whole_body(plan, rows, alone, s);
    measure_points(plan, s, zero);
    close_limbs(plan, settings, zero, off, s);
    take_posture(s.kept_rotation, s.kept_place, plan, !off, s);
    s.mobility = mobility;
  }
}

}  // namespace marey::retarget
