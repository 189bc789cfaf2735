// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/whole_body_step.h"

namespace marey::retarget {

/// What a loop knows of each lane. The thesis' loop (retarget/thesis_solve.h) uses six
/// of them, two in its own way: `damping` is the share of a step that it dares, `square`
/// what balance lacks.
template <class F>
struct Progress {
  F iterations{};  ///< Whole-body steps so far.
  F steps{};       ///< Of them, since the reference.
  F merit{};       ///< The best posture's.
  F stalled{};     ///< Steps that hardly helped, in a row.
  F damping{};
  /// Of the best posture's errors: long ones are damped more (Sugihara 2011).
  F square{};
  F homing{};  ///< Share of its straying from the reference that a step takes back.
  F level{};   ///< Wishes up to this level are asked.
  F capped{};  ///< 1: the cap on iterations ended it, and nothing else would have.
};

/// A posture far from its targets has other things to do than to go home.
template <class F>
[[nodiscard]] inline F homing_of(const Progress<F>& progress) {
  const F homing = progress.homing / (num<F>(1) + num<F>(4) * progress.square);
  // The first step is at home: exactly nothing to take back, not rounding's.
  return select(progress.steps > num<F>(0), homing, num<F>(0));
}

/// Rows of supports and balance are met exactly; this much keeps their pivots sound.
inline constexpr double kExactDamping = 1e-5;
inline constexpr double kLeastDamping = 1e-4;
inline constexpr double kDampingPerSquare = 0.03;
/// An error enters a step as if it were at most this long, in units.
inline constexpr double kLongestError = 0.5;

/// How far each turning joint has turned from its reference, as a vector in world axes.
template <class F>
void measure_straying(const Plan& plan, const F& share, Lanes<F>& s) {
  // Zeros have signs: nothing is the same whatever other lanes do.
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
    // From half a turn away both ways home are as long: neither is taken.
    const F sure = clamp(num<F>(-8) * back.w, num<F>(-2), num<F>(2));
    Vec3<F> turned = sure * vector_part(back);
    if (plan.turning[i] == Turning::kHinge) {
      const Vec3<F>& axis = s.axis[static_cast<std::size_t>(plan.limb_of_hinge[i])];
      turned = dot(axis, turned) * axis;
    }
    s.strayed[i] = select(homes, share * turned, none);
  }
}

/// By how much a wish's point would go back if every joint did.
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

/// Keeps of a wish's rows what is `asked` (1 or 0 each) and damps them. Rows that nobody
/// asks for are taken out: an identity of their own.
template <class F>
void keep_rows(int side, int row, const Vec3<F>& asked, const F& damping, Lanes<F>& s) {
  const F one = num<F>(1);
  const auto block = [&](int i, int j) {
    return &s.blocks[static_cast<std::size_t>(9 * (i * side + j))];
  };
  F* diagonal = block(row, row);
  if (!any((asked.x < one) | (asked.y < one) | (asked.z < one))) {
    for (std::size_t e = 0; e < 3; ++e) diagonal[4 * e] = diagonal[4 * e] + damping;
    return;
  }
  const F keep[3] = {asked.x, asked.y, asked.z};
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

/// The system of one step: `blocks` and `right` of the lanes, and how far joints strayed.
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
    const F asked = select(is_served(point, p, level), one, zero);
    const F soft = progress.damping *
                   (one + num<F>(kDampingPerSquare / kLeastDamping) * progress.square) /
                   max(p.weight, num<F>(1e-6));
    const F damping = select(
        (p.holds > zero) | (num<F>(point.level) < one), num<F>(kExactDamping), soft);
    const int row = rows.row_of(static_cast<int>(k));
    const F long_enough = num<F>(kLongestError);
    const F scale = long_enough / max(length(p.error), long_enough);
    s.right[static_cast<std::size_t>(row)] = scale * p.error;
    if (strays) {
      Vec3<F>& right = s.right[static_cast<std::size_t>(row)];
      right = select(homes, right + strayed_of(point, p, travelled, s), right);
    }
    keep_rows(side, row, Vec3<F>{asked, asked, asked}, damping, s);
    Vec3<F>& right = s.right[static_cast<std::size_t>(row)];
    right = asked * right;
  }
  if (rows.balance) {
    const Vec3<F> error = balance_error(s);
    const F long_enough = num<F>(0.5 * kLongestError);
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

/// No multiplier of a sound step is longer: an error over kExactDamping, and what a long
/// lever strays.
inline constexpr double kLongestMultiplier = 1e7;

/// Points so far away that single precision leaves nothing of the near ones beside them
/// give systems without a sound solution: who has one takes no step for its wishes. Also
/// what is no number is not at most anything.
template <class F>
void drop_unsound(int side, Lanes<F>& s) {
  const F most = num<F>(kLongestMultiplier);
  Mask<F> sound = num<F>(0) < num<F>(1);
  for (int row = 0; row < side; ++row) {
    const Vec3<F>& m = s.right[static_cast<std::size_t>(row)];
    sound = sound & (abs(m.x) <= most) & (abs(m.y) <= most) & (abs(m.z) <= most);
  }
  if (all(sound)) return;
  const Vec3<F> none{num<F>(0), num<F>(0), num<F>(0)};
  for (int row = 0; row < side; ++row) {
    Vec3<F>& m = s.right[static_cast<std::size_t>(row)];
    m = select(sound, m, none);
  }
}

/// By how much joint `j` turns for the solved multipliers, in world axes. [rad]
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

/// Turns the joints by what the multipliers say, and moves the root.
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
  // All turns are seen in the posture before the step: taken before any is made.
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    if (plan.turning[i] == Turning::kRigid) continue;
    const Vec3<F> by =
        own_share(plan, i, level, s) * turn_of(plan, rows, j, s) - s.strayed[i];
    // Elbows and knees that overturn land behind their limits, or beyond half a turn:
    // they would come back the other way.
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

/// One step for all wishes up to each lane's level, in every lane. Precondition: the
/// posture is measured (measure() in retarget/adapt_errors.h); the new one is not. About
/// 3,500 operations for 21 joints and four wishes.
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
