// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/whole_body_step.h"

namespace marey::retarget {

/// State of a loop per lane. The thesis' loop (retarget/adapt/kernel/thesis_solve.h) uses
/// six of the fields, two with another meaning: `damping` is the fraction of a step to
/// apply, `square` the balance error.
template <class F>
struct Progress {
  F iterations{};  ///< Whole-body steps so far.
  F steps{};       ///< Steps since the last start from the reference.
  F merit{};       ///< Merit of the best posture.
  F stalled{};     ///< Consecutive steps with negligible improvement.
  F damping{};
  /// Squared error of the best posture: larger errors are damped more (Sugihara 2011).
  F square{};
  F homing{};  ///< Fraction of the departure from the reference that a step takes back.
  F level{};   ///< Targets up to this level are active.
  F capped{};  ///< 1: the limit on iterations ended the loop, and no other criterion
               ///< would have.
};

/// Returns the homing fraction. It is reduced for a posture far from its targets.
template <class F>
[[nodiscard]] inline F homing_of(const Progress<F>& progress) {
  const F homing = progress.homing / (num<F>(1) + num<F>(4) * progress.square);
  // The first step starts at the reference: the departure is exactly 0, without rounding
  // errors.
  return select(progress.steps > num<F>(0), homing, num<F>(0));
}

/// Damping of the rows of supports and balance: they are met exactly, and the pivots stay
/// nonzero.
inline constexpr double kExactDamping = 1e-5;
inline constexpr double kMinDamping = 1e-4;
inline constexpr double kDampingPerSquare = 0.03;
/// Maximum length of an error in a step, in units; longer errors are shortened.
inline constexpr double kMaxStepError = 0.5;

/// Computes the rotation of each rotating joint from its reference, as a vector in world
/// axes.
template <class F>
void measure_straying(const Plan& plan, const F& share, Lanes<F>& s) {
  // Zeros have signs: the zero here is independent of other lanes.
  const Vec3<F> none{num<F>(0), num<F>(0), num<F>(0)};
  const Mask<F> homes = share > num<F>(0);
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    if (plan.turning[i] == Turning::kRigid) continue;
    const Quat<F> unturned =
        j == 0
            ? s.reference_local[i]
            : s.rotation[static_cast<std::size_t>(plan.parent[i])] * s.reference_local[i];
    const Quat<F> back = unturned * conjugate(s.rotation[i]);
    // Near half a turn both directions home are equally long, so neither is used.
    const F sure = clamp(num<F>(-8) * back.w, num<F>(-2), num<F>(2));
    Vec3<F> turned = sure * vector_part(back);
    if (plan.turning[i] == Turning::kHinge) {
      const Vec3<F>& axis = s.axis[static_cast<std::size_t>(plan.limb_of_hinge[i])];
      turned = dot(axis, turned) * axis;
    }
    s.strayed[i] = select(homes, share * turned, none);
  }
}

/// Returns the displacement of a target's point if every joint returned to the reference.
template <class F>
[[nodiscard]] Vec3<F> strayed_of(const PointPlan& point,
                                 const LanePoint<F>& p,
                                 const Vec3<F>& travelled,
                                 const Lanes<F>& s) {
  Vec3<F> out{num<F>(0), num<F>(0), num<F>(0)};
  if (point.moves_root && !point.turns_only()) out = travelled;
  for (const int j : point.chain) {
    const auto i = static_cast<std::size_t>(j);
    out += point.turns_only() ? s.strayed[i] : cross(s.strayed[i], p.place - s.place[i]);
  }
  return out;
}

/// Multiplies a target's rows by `requested` (1 or 0 each) and damps them. Inactive rows
/// become rows of the identity.
template <class F>
void keep_rows(
    int side, int row, const Vec3<F>& requested, const F& damping, Lanes<F>& s) {
  const F one = num<F>(1);
  const auto block = [&](int i, int j) {
    return &s.blocks[static_cast<std::size_t>(9 * (i * side + j))];
  };
  F* diagonal = block(row, row);
  if (!any((requested.x < one) | (requested.y < one) | (requested.z < one))) {
    for (std::size_t e = 0; e < 3; ++e) diagonal[4 * e] = diagonal[4 * e] + damping;
    return;
  }
  const F keep[3] = {requested.x, requested.y, requested.z};
  for (int j = 0; j < row; ++j) {
    F* b = block(row, j);
    for (std::size_t e = 0; e < 9; ++e) b[e] = b[e] * keep[e / 3];
  }
  for (int i = row + 1; i < side; ++i) {
    F* b = block(i, row);
    for (std::size_t e = 0; e < 9; ++e) b[e] = b[e] * keep[e % 3];
  }
  for (std::size_t e = 0; e < 9; ++e) {
    diagonal[e] = diagonal[e] * keep[e / 3] * keep[e % 3];
  }
  for (std::size_t e = 0; e < 3; ++e) {
    diagonal[4 * e] = diagonal[4 * e] + damping + (one - keep[e]);
  }
}

/// Builds the system of one step: `blocks` and `right` of the lanes, and the departures
/// of the joints.
template <class F>
void form_system(const Plan& plan,
                 const RowOrder& rows,
                 int side,
                 const Progress<F>& progress,
                 Lanes<F>& s) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F& level = progress.level;
  sum_runs(plan, rows.balance, level, s);
  form_point_blocks(plan, rows, side, s);
  if (rows.balance) form_balance_blocks(plan, rows, side, level, s);
  add_hinges(plan, rows, side, level, s);
  const F homing = homing_of(progress);
  const Mask<F> homes = homing > zero;
  const bool strays = any(homes);
  if (strays) {
    measure_straying(plan, homing, s);
  } else {
    for (const int j : plan.live)
      s.strayed[static_cast<std::size_t>(j)] = {zero, zero, zero};
  }
  const Vec3<F> travelled = homing * (s.place[0] - s.reference_place[0]);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    LanePoint<F>& p = s.points[k];
    const F requested = select(is_served(point, p, level), one, zero);
    const F soft = progress.damping *
                   (one + num<F>(kDampingPerSquare / kMinDamping) * progress.square) /
                   max(p.weight, num<F>(1e-6));
    const F damping = select(
        (p.holds > zero) | (num<F>(point.level) < one), num<F>(kExactDamping), soft);
    const int row = rows.row_of(static_cast<int>(k));
    const F long_enough = num<F>(kMaxStepError);
    const F scale = long_enough / max(length(p.error), long_enough);
    s.right[static_cast<std::size_t>(row)] = scale * p.error;
    if (strays) {
      Vec3<F>& right = s.right[static_cast<std::size_t>(row)];
      right = select(homes, right + strayed_of(point, p, travelled, s), right);
    }
    keep_rows(side, row, Vec3<F>{requested, requested, requested}, damping, s);
    Vec3<F>& right = s.right[static_cast<std::size_t>(row)];
    right = requested * right;
  }
  if (rows.balance) {
    const Vec3<F> error = balance_error(s);
    const F long_enough = num<F>(0.5 * kMaxStepError);
    const F scale = long_enough / max(length(error), long_enough);
    Vec3<F> back = travelled;
    for (const int j : plan.live) {
      const auto i = static_cast<std::size_t>(j);
      if (!strays || plan.turning[i] == Turning::kRigid) continue;
      back += cross(s.strayed[i], s.lever[i]);
    }
    back = select(homes, back, travelled);
    s.right[static_cast<std::size_t>(rows.supports)] = scale * error + back;
    keep_rows(side,
              rows.supports,
              Vec3<F>{s.balance, s.balance * s.vertical, s.balance},
              num<F>(kExactDamping),
              s);
    Vec3<F>& right = s.right[static_cast<std::size_t>(rows.supports)];
    right = {s.balance * right.x, s.balance * s.vertical * right.y, s.balance * right.z};
  }
}

/// Upper bound for the multipliers of a well-conditioned step: an error over
/// kExactDamping plus the departure at a long lever.
inline constexpr double kMaxMultiplier = 1e7;

/// Points so far away that single precision cancels the near ones give ill-conditioned
/// systems: such lanes take no step for their targets. NaN also fails the comparison.
template <class F>
void drop_unsound(int side, Lanes<F>& s) {
  const F max_multiplier = num<F>(kMaxMultiplier);
  Mask<F> sound = num<F>(0) < num<F>(1);
  for (int row = 0; row < side; ++row) {
    const Vec3<F>& m = s.right[static_cast<std::size_t>(row)];
    sound = sound & (abs(m.x) <= max_multiplier) & (abs(m.y) <= max_multiplier) &
            (abs(m.z) <= max_multiplier);
  }
  if (all(sound)) return;
  const Vec3<F> none{num<F>(0), num<F>(0), num<F>(0)};
  for (int row = 0; row < side; ++row) {
    Vec3<F>& m = s.right[static_cast<std::size_t>(row)];
    m = select(sound, m, none);
  }
}

/// Returns the rotation of joint `j` for the solved multipliers, in world axes. [rad]
template <class F>
[[nodiscard]] Vec3<F> turn_of(const Plan& plan,
                              const RowOrder& rows,
                              int j,
                              const Lanes<F>& s) {
  const auto i = static_cast<std::size_t>(j);
  Vec3<F> turn{num<F>(0), num<F>(0), num<F>(0)};
  for (int n = plan.through_begin[i]; n < plan.through_begin[i + 1]; ++n) {
    const int k = plan.through[static_cast<std::size_t>(n)];
    const auto ik = static_cast<std::size_t>(k);
    const Vec3<F>& lambda = s.right[static_cast<std::size_t>(rows.row_of(k))];
    turn += plan.points[ik].turns_only() ? lambda
                                         : cross(s.points[ik].place - s.place[i], lambda);
  }
  if (rows.balance) {
    turn += cross(s.lever[i], s.right[static_cast<std::size_t>(rows.supports)]);
  }
  if (plan.turning[i] == Turning::kHinge) {
    const Vec3<F>& axis = s.axis[static_cast<std::size_t>(plan.limb_of_hinge[i])];
    turn = dot(axis, turn) * axis;
  }
  return turn;
}

/// Rotates the joints according to the multipliers, and moves the root.
template <class F>
void apply_step(const Plan& plan,
                const RowOrder& rows,
                const F& homing,
                const F& level,
                Lanes<F>& s) {
  const F zero = num<F>(0);
  Vec3<F> travel{zero, zero, zero};
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    if (!plan.points[k].moves_root || plan.points[k].turns_only()) continue;
    travel += s.right[static_cast<std::size_t>(rows.row_of(static_cast<int>(k)))];
  }
  if (rows.balance) travel += s.right[static_cast<std::size_t>(rows.supports)];
  // All rotations refer to the posture before the step, so they are computed before any
  // is applied.
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    if (plan.turning[i] == Turning::kRigid) continue;
    const Vec3<F> by =
        own_share(plan, i, level, s) * turn_of(plan, rows, j, s) - s.strayed[i];
    // Limits the step: elbows and knees that rotate too far end beyond their limits or
    // beyond half a turn, and would return in the other direction.
    s.turn[i] =
        plan.turning[i] == Turning::kHinge ? rotation_within(by) : rotation_by(by);
  }
  const Vec3<F> from_reference = s.place[0] - s.reference_place[0];
  const Vec3<F> root = root_share(s);
  s.place[0] = s.reference_place[0] + (num<F>(1) - homing) * from_reference +
               Vec3<F>{root.x * travel.x, root.y * travel.y, root.z * travel.z};
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const bool turns = plan.turning[i] != Turning::kRigid;
    if (j == 0) {
      s.rotation[0] = trued(s.turn[0] * s.rotation[0]);
      continue;
    }
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    s.turn[i] = turns ? s.turn[p] * s.turn[i] : s.turn[p];
    place_joint(plan, s, j);
    const Quat<F> before = s.rotation[i];
    s.rotation[i] = trued(s.turn[i] * before);
    if (turns && plan.limit_of[i] >= 0) {
      s.rotation[i] = trued(
          s.rotation[p] * within_limits(s, i, conjugate(s.rotation[p]) * s.rotation[i]));
      s.turn[i] = s.rotation[i] * conjugate(before);
    }
  }
}

/// Performs one step for all targets up to each lane's level, in every lane.
/// Precondition: the posture is measured (measure() in
/// retarget/adapt/kernel/adapt_errors.h); the new one is not. About 3,500 operations for
/// 21 joints and four targets.
template <class F>
void step_whole_body(const Plan& plan,
                     const RowOrder& rows,
                     const Progress<F>& progress,
                     Lanes<F>& s) {
  const int side = static_cast<int>(plan.points.size()) + (rows.balance ? 1 : 0);
  form_system(plan, rows, side, progress, s);
  solve_blocks(side, num<F>(kExactDamping), s.blocks.data(), s.right.data());
  drop_unsound(side, s);
  apply_step(plan, rows, homing_of(progress), progress.level, s);
}

}  // namespace marey::retarget
