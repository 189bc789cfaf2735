// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt_ground.h"
#include "retarget/close_limbs.h"
#include "retarget/whole_body_solve.h"

/// The strict method, over lanes.
///
/// 1. Limbs alone: every limb takes its wish analytically. While all are within
/// comfortable
///    reach that is the answer (the thesis: the trunk moves only when limbs do not
///    suffice), and no loop runs.
/// 2. The whole body: damped Gauss-Newton steps from the reference posture; as soon as
/// the
///    errors are small the limbs close them exactly.
/// 3. Between 88 and 100 % of a limb's reach the first passes smoothly over into the
///    second, so that the trunk starts to help before an arm is straight, and a target
///    that moves continuously moves the posture continuously.
namespace marey::retarget {

inline constexpr double kComfortableReach = 0.88;
/// Limbs close errors shorter than this, in units.
inline constexpr double kCloseBelow = 0.008;
inline constexpr double kCloseBelowBalanced = 0.03;
inline constexpr double kStartDamping = kLeastDamping;
inline constexpr double kStalledSteps = 2.5;
inline constexpr double kStartHoming = 1.0;
inline constexpr double kHomingFades = 0.85;

template <class F>
struct Solve {
  Progress<F> progress;
  F whole_body{};  ///< Share of the whole body's answer, 0..1.
  F closed{};      ///< 1: the best posture is closed by its limbs already.
  std::vector<Quat<F>> alone_rotation;
  Vec3<F> alone_root;
  bool keeps_alone = false;
};

struct Shape {
  RowOrder rows;
  double last_level = 1.0;
};

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

/// The largest error of what is asked, over its precision; and the mean, in units.
template <class F>
struct Errors {
  F worst_over_precision;
  F worst;
  F mean;
  F square;  ///< Weighted mean of squares.
  F balance;
};

template <class F>
[[nodiscard]] Errors<F> measure(const Plan& plan,
                                bool balance,
                                const F& level,
                                Lanes<F>& s) {
  const F zero = num<F>(0);
  measure_points(plan, s, level);
  Errors<F> out{zero, zero, zero, zero, zero};
  F weights = zero;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const LanePoint<F>& p = s.points[k];
    const F error = length(p.error);
    out.worst_over_precision = max(out.worst_over_precision, error * p.per_precision);
    if (!plan.points[k].direct) out.worst = max(out.worst, error);
    const F weight = select(is_asked(plan.points[k], p, level), p.weight, zero);
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

/// How much the whole body has to help: 0 while every limb stays in comfortable reach of
/// its first wish, or no further stretched or folded than in the reference; 1 beyond.
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
    if (point.direct) continue;
    // The distance of a point on the upper bone is what it is.
    if (point.limb >= 0 && point.place == LimbPlace::kUpper) continue;
    if (point.limb < 0) {
      share = select(asked & (length(p.error) > num<F>(1e-6)), one, share);
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
    const F stretch = smooth((wanted - begin) / (one - begin));
    const F least = abs(near_bone - far_bone) * over_reach;
    const F fold = min(now, least + num<F>(0.12));
    const F folded = smooth((fold - wanted) / max(fold - least, num<F>(0.002)));
    share = select(asked, max(share, max(stretch, folded)), share);
  }
  // Less than this is rounding's.
  return select(share < num<F>(1e-5), num<F>(0), share);
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
  const F last = num<F>(shape.last_level);
  ground_reference(plan, settings, shape.rows.balance, mask, s);
  take_posture(s.reference_rotation, s.reference_place, plan, mask, s);
  measure_points(plan, s, last);
  F share = num<F>(1);
  if (!shape.rows.balance) share = help_needed(plan, settings, last, s);
  const Mask<F> tries = mask & (share < num<F>(1));
  if (any(tries)) {
    close_limbs(plan, settings, last, tries, s);
    const Errors<F> errors = measure(plan, false, last, s);
    share = select(errors.worst_over_precision > num<F>(1), num<F>(1), share);
    for (const int j : plan.live) {
      const auto i = static_cast<std::size_t>(j);
      solve.alone_rotation[i] = select(tries, s.rotation[i], solve.alone_rotation[i]);
    }
    solve.alone_root = select(tries, s.place[0], solve.alone_root);
  }
  solve.whole_body = select(mask, share, solve.whole_body);
  const Mask<F> loops = mask & (share > zero);
  Progress<F>& p = solve.progress;
  p.iterations = select(mask, zero, p.iterations);
  p.square = select(mask, zero, p.square);
  p.merit = select(mask, num<F>(1e9), p.merit);
  p.stalled = select(mask, zero, p.stalled);
  p.damping = select(mask, num<F>(kStartDamping), p.damping);
  p.homing = select(mask, num<F>(kStartHoming), p.homing);
  p.level = select(mask, min(num<F>(1), last), p.level);
  if (any(loops)) {
    take_posture(s.reference_rotation, s.reference_place, plan, loops, s);
    static_cast<void>(measure(plan, shape.rows.balance, p.level, s));
  }
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
  step_whole_body(plan, shape.rows, p, s);
  if (plan.has_hamstrings()) spare_hamstrings(plan, settings, p.level > zero, s);
  Errors<F> errors = measure(plan, balance, p.level, s);
  const Mask<F> near = errors.worst < num<F>(balance ? kCloseBelowBalanced : kCloseBelow);
  if (any(near)) {
    close_limbs(plan, settings, p.level, near, s);
    errors = measure(plan, balance, p.level, s);
  }
  p.iterations = p.iterations + one;

  const F merit = sqrt(errors.square) + num<F>(2) * errors.balance;
  const Mask<F> better = merit < p.merit;
  const F gain = p.merit - merit;
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.best_rotation[i] = select(better, s.rotation[i], s.best_rotation[i]);
    s.best_place[i] = select(better, s.place[i], s.best_place[i]);
  }
  p.merit = select(better, merit, p.merit);
  solve.closed = select(better, select(near, one, zero), solve.closed);
  const Mask<F> met =
      (errors.worst_over_precision <= one) & (errors.balance <= s.balance_precision);
  // A step that made things worse is taken back and tried again, more carefully.
  const Mask<F> worse = !better & !met;
  if (any(worse)) {
    take_posture(s.best_rotation, s.best_place, plan, worse, s);
    static_cast<void>(measure(plan, balance, p.level, s));
  }
  p.damping = select(worse, num<F>(8) * p.damping, p.damping);
  p.square = select(better, errors.square, p.square);
  p.homing = select(worse, zero, num<F>(kHomingFades) * p.homing);
  const Mask<F> idle = gain < max(num<F>(settings.threshold), num<F>(0.002) * p.merit);
  p.stalled = select(idle, p.stalled + one, zero);
  const Mask<F> ended = met | (p.stalled > num<F>(kStalledSteps)) |
                        (p.iterations >= num<F>(settings.max_iterations));

  const Mask<F> goes_on = ended & (p.level < num<F>(shape.last_level)) &
                          (p.iterations < num<F>(settings.max_iterations));
  if (any(goes_on)) {
    take_posture(s.best_rotation, s.best_place, plan, goes_on, s);
    close_limbs(plan, settings, p.level, goes_on, s);
    static_cast<void>(measure(plan, balance, p.level, s));
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const Mask<F> held = goes_on & (num<F>(plan.points[k].level) <= p.level) &
                           (p.level < num<F>(plan.points[k].level + 1));
      s.points[k].held = select(held, s.points[k].place, s.points[k].held);
    }
    p.level = select(goes_on, p.level + one, p.level);
    p.merit = select(goes_on, num<F>(1e9), p.merit);
    p.stalled = select(goes_on, zero, p.stalled);
    p.damping = select(goes_on, num<F>(kStartDamping), p.damping);
    p.homing = select(goes_on, zero, p.homing);
    static_cast<void>(measure(plan, balance, p.level, s));
  }
  return ended & !goes_on;
}

/// The final posture of lanes that are done: the best, closed by its limbs, mixed with
/// what limbs alone would do. Leaves its measures.
template <class F>
[[nodiscard]] Errors<F> finish_lanes(const Plan& plan,
                                     const Shape& shape,
                                     const SolveSettings& settings,
                                     const Mask<F>& mask,
                                     Lanes<F>& s,
                                     Solve<F>& solve) {
  const F zero = num<F>(0);
  const F one = num<F>(1);
  const F last = num<F>(shape.last_level);
  const Mask<F> looped = mask & (solve.whole_body > zero);
  if (!any(looped)) return measure(plan, shape.rows.balance, last, s);
  take_posture(s.best_rotation, s.best_place, plan, looped, s);
  const F share = solve.whole_body;
  const Mask<F> mixes = looped & (share < one);
  if (any(mixes)) {
    for (const int j : plan.live) {
      const auto i = static_cast<std::size_t>(j);
      s.rotation[i] = select(
          mixes, between(solve.alone_rotation[i], s.rotation[i], share), s.rotation[i]);
    }
    s.place[0] = select(
        mixes, solve.alone_root + share * (s.place[0] - solve.alone_root), s.place[0]);
    place_live_joints(plan, s);
  }
  const Mask<F> open = looped & (mixes | (solve.closed < num<F>(0.5)));
  if (any(open)) {
    static_cast<void>(measure(plan, false, last, s));
    spare_hamstrings(plan, settings, open, s);
    close_limbs(plan, settings, last, open, s);
  }
  return measure(plan, shape.rows.balance, last, s);
}

}  // namespace marey::retarget
