// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "retarget/adapt/algebra/fade_shares.h"
#include "retarget/adapt/kernel/adapt_load.h"
#include "retarget/adapt/kernel/adapt_solve.h"
#include "retarget/adapt/kernel/lane_kernel.h"
#include "retarget/adapt/kernel/lane_result.h"
#include "retarget/adapt/kernel/thesis_solve.h"

/// Mean of postures, over lanes, while constraints fade in or out or while one control
/// fades to the other.
///
/// Constraints fade between the postures without and with them. The result is the mean of
/// the postures Si for all constraints with at least an activation ai (fade_pass()). It
/// is continuous in every activation, also where two activations cross, and exact where
/// nothing fades (the Lovasz extension of the map from sets of constraints to postures).
/// Targets that all the Si meet are then restored in the mean.
namespace marey::retarget {

/// Rounds that correct the centre of mass of a mean; each leaves about a fifth. The
/// number is fixed, because an early end would cause a jump.
inline constexpr int kRootRounds = 6;
/// Smaller errors of the centre of mass are rounding errors, in units.
inline constexpr double kSettled = 2e-7;

/// Weighted sums over the postures that are blended.
template <class F>
struct FadeSums {
  std::vector<Quat<F>> rotation;  ///< After take_mean() the mean rotations.
  std::vector<F> beyond;          ///< Largest angle of a joint beyond its limits. [rad]
  Vec3<F> root;
  Vec3<F> com;
  Vec3<F> com_target;
  std::vector<Vec3<F>> left;  ///< Per target: vector from the point to the target.
  std::vector<F> firmness;    ///< Per target: fraction of the distance to close, 0 to 1.

  explicit FadeSums(const Plan& plan)
      : rotation(plan.parent.size()),
        beyond(plan.parent.size()),
        left(plan.points.size()),
        firmness(plan.points.size()) {}
};

template <class F>
void clear_sums(FadeSums<F>& sums) {
  const F zero = num<F>(0);
  const Vec3<F> none{zero, zero, zero};
  for (Quat<F>& q : sums.rotation) q = {zero, zero, zero, zero};
  for (F& beyond : sums.beyond) beyond = zero;
  for (Vec3<F>& left : sums.left) left = none;
  sums.root = sums.com = sums.com_target = none;
}

/// Adds the solved postures of the lanes in `mask`, weighted by `share`.
template <class F>
void add_to_mean(const Plan& plan,
                 bool balance,
                 const F& share,
                 const Mask<F>& mask,
                 Lanes<F>& s,
                 FadeSums<F>& sums) {
  const F zero = num<F>(0);
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const Quat<F>& q = s.rotation[i];
    Quat<F>& sum = sums.rotation[i];
    const auto product = [](const Quat<F>& a, const Quat<F>& b) {
      return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
    };
    // Two quaternions represent a rotation; uses the one on the side of the sum. Nearly
    // equal rotations then never cancel, and the sum only grows. The first is on the
    // reference's side.
    const Mask<F> is_first = product(sum, sum) <= zero;
    const Quat<F> like = select(is_first, s.reference_rotation[i], sum);
    const F sign = select(product(q, like) < zero, negated(share), share);
    const Quat<F> more{
        sum.w + sign * q.w, sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z};
    sum = select(mask, more, sum);
    if (plan.limit_of[i] < 0 || j == 0) continue;
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    const Quat<F> kept = limited(plan, s, j, s.rotation[p], q);
    const F angle = length(turn_left(q, kept));
    sums.beyond[i] = select(mask & (sums.beyond[i] < angle), angle, sums.beyond[i]);
  }
  const auto add = [&](const Vec3<F>& v, Vec3<F>& sum) {
    sum = select(mask, sum + share * v, sum);
  };
  add(s.place[0], sums.root);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<F>& p = s.points[k];
    p.place = place_of(plan.points[k], p, s);
    add(target_of(plan.points[k], p, s) - p.place, sums.left[k]);
  }
  if (!balance) return;
  measure_balance(plan, s);
  add(s.com, sums.com);
  add(s.com_target, sums.com_target);
}

/// Returns the numbers of all lanes, to compute them one by one.
template <class F>
[[nodiscard]] std::span<float> numbers_of(F& x) {
  return {&lane_of(x, 0), sizeof(F) / sizeof(float)};
}

/// Computes the mean posture, within limits where the blended postures are.
template <class F>
void take_mean(const Plan& plan, Lanes<F>& s, FadeSums<F>& sums) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    s.rotation[i] = normalized(sums.rotation[i]);
    if (plan.limit_of[i] >= 0 && j != 0) {
      // The mean of two postures within a limit may exceed it. If one of them exceeds it
      // (possible for supports and references), the mean is not clamped.
      const auto p = static_cast<std::size_t>(plan.parent[i]);
      const Quat<F> kept = limited(plan, s, j, s.rotation[p], s.rotation[i]);
      F keeps = sums.beyond[i];
      limit_shares(numbers_of(keeps));
      s.rotation[i] = between(s.rotation[i], kept, keeps);
    }
    sums.rotation[i] = s.rotation[i];
  }
  s.place[0] = sums.root;
  place_live_joints(plan, s);
}

/// Sets the targets to the mean result of the blended postures, on the mean posture:
/// where all of them agree, their error (for balance or for higher levels) stays.
/// Extremities get their rotation in the mean: rotations fade as the postures do, and a
/// rotation that all postures keep is kept in the mean.
template <class F>
void aim_at_mean(const Plan& plan,
                 const SolveSettings& settings,
                 Lanes<F>& s,
                 const FadeSums<F>& sums) {
  const F zero = num<F>(0);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<F>& p = s.points[k];
    p.place = place_of(plan.points[k], p, s);
    const Vec3<F> wanted = target_of(plan.points[k], p, s) - sums.left[k];
    p.target = p.place + sums.firmness[k] * (wanted - p.place);
    p.error = select(p.active > zero, p.target - p.place, Vec3<F>{zero, zero, zero});
  }
  for (const LimbPlan& limb : plan.limbs) {
    F share = num<F>(settings.keeps_orientation ? 1 : 0);
    const auto raise = [&](int k) {
      const F& firm = sums.firmness[static_cast<std::size_t>(k)];
      share = select(share < firm, firm, share);
    };
    for (const int k : limb.points) raise(k);
    for (const int k : limb.orientations) raise(k);
    const auto e = static_cast<std::size_t>(limb.end);
    const Quat<F> aim = between(s.rotation[e], sums.rotation[e], share);
    s.reference_rotation[e] = aim;
    for (const int k : limb.orientations) {
      s.points[static_cast<std::size_t>(k)].goal.rotation = aim;
    }
  }
}

/// Closes supports first, then every other limb with a target, in the lanes of `mask`.
template <class F>
void close_mean(const Plan& plan,
                const Shape& shape,
                const SolveSettings& settings,
                const Mask<F>& mask,
                Lanes<F>& s,
                const FadeSums<F>& sums) {
  aim_at_mean(plan, settings, s, sums);
  SolveSettings keeping = settings;
  keeping.keeps_orientation = true;
  const F last = num<F>(shape.last_level);
  const F zero = num<F>(0);
  reach_supports(plan, keeping, mask, s);
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const LimbPlan& limb = plan.limbs[l];
    Mask<F> closes = num<F>(settings.keeps_orientation ? 1 : 0) > zero;
    for (const int k : limb.points) {
      closes = closes | (s.points[static_cast<std::size_t>(k)].active > zero);
    }
    for (const int k : limb.orientations) {
      closes = closes | (s.points[static_cast<std::size_t>(k)].active > zero);
    }
    closes = closes & mask;
    if (any(closes)) close_limb(plan, static_cast<int>(l), keeping, last, closes, s);
  }
}

/// Moves the centre of mass to the mean of those of the blended postures, by the root
/// alone: whole-body steps would jump when a fading support is added. Errors remain where
/// legs are at full stretch or the root may not move.
template <class F>
void settle_mean(const Plan& plan,
                 const Shape& shape,
                 const SolveSettings& settings,
                 const Mask<F>& mask,
                 Lanes<F>& s,
                 const FadeSums<F>& sums) {
  measure_balance(plan, s);
  s.com_target = sums.com;
  F share = length(balance_error(s));
  F precision = s.balance_precision;
  settle_shares(numbers_of(share), numbers_of(precision));
  Mask<F> moves = mask & (share > num<F>(0));
  if (!any(moves)) return;
  s.com_target = s.com + share * (sums.com - s.com);
  for (int round = 0; round < kRootRounds; ++round) {
    measure_balance(plan, s);
    const Vec3<F> error = balance_error(s);
    moves = moves & !(length(error) < num<F>(kSettled));
    if (!any(moves)) return;
    const Vec3<F> by{s.root_weight_on_floor * error.x,
                     s.root_weight * error.y,
                     s.root_weight_on_floor * error.z};
    s.place[0] = select(moves, s.place[0] + by, s.place[0]);
    place_live_joints(plan, s);
    close_mean(plan, shape, settings, moves, s, sums);
  }
}

/// Solves up to `Width` bodies whose constraints fade, each with its own number of
/// passes. A pass is one solve of every body that has it.
template <class F, int Width>
class FadeLoop {
 public:
  FadeLoop(FadeJobs& jobs, Lanes<F>& lanes, Solve<F>& solve, FadeSums<F>& sums)
      : jobs_(jobs), s_(lanes), solve_(solve), sums_(sums) {}

  /// Loads and solves one batch, and stores its results in `result`, one after the other.
  /// Returns false if there is none.
  bool run(float* result) {
    if (!load()) return false;
    clear_sums(sums_);
    figures_ = {num<F>(0), num<F>(0), num<F>(0)};
    for (int pass = 0; pass < max_passes_; ++pass) run_pass(pass);
    finish();
    for (int lane = 0; lane < count_; ++lane) {
      store_result(*task_.plan, figures_, lane, s_, result);
      jobs_.answer_faded(lane, result);
    }
    return true;
  }

 private:
  [[nodiscard]] bool load() {
    task_ = jobs_.task(0);
    const Plan& plan = *task_.plan;
    F used = num<F>(0);
    count_ = 0;
    max_passes_ = 0;
    LaneJob job;
    while (count_ < Width && jobs_.next(count_, job)) {
      load_body(plan, job.body, count_, s_);
      load_posture(plan, job.posture, count_, s_);
      load_balance(job.balance, count_, s_);
      // Supports are measured with the reference, so that targets must be finite.
      load_targets(plan, job.targets, count_, s_);
      auto& passes = passes_[static_cast<std::size_t>(count_)];
      passes = jobs_.passes(count_);
      max_passes_ = passes > max_passes_ ? passes : max_passes_;
      lane_of(used, count_) = 1;
      ++count_;
    }
    used_ = used;
    if (count_ == 0) return false;
    stand_reference(plan, task_.shape.rows.balance, used > num<F>(0.5), s_);
    return true;
  }

  // Solves the lanes that have this pass, and adds each posture to the mean as soon as it
  // is done.
  void run_pass(int pass) {
    task_ = jobs_.task(pass);
    const Plan& plan = *task_.plan;
    const F zero = num<F>(0);
    F runs = zero;
    F share = zero;
    for (int lane = 0; lane < count_; ++lane) {
      if (pass >= passes_[static_cast<std::size_t>(lane)]) continue;
      const FadeJobs::Pass part = jobs_.pass(lane, pass);
      load_targets(plan, part.targets, lane, s_);
      lane_of(share, lane) = part.share;
      lane_of(runs, lane) = 1;
    }
    const Mask<F> all = runs > zero;
    if (task_.by_thesis) {
      begin_thesis(plan, *task_.thesis, task_.settings, all, s_, solve_);
    } else {
      begin_lanes(plan, task_.shape, task_.settings, all, s_, solve_);
    }
    Mask<F> done = all & (solve_.needs_body <= zero);
    while (true) {
      if (any(done)) {
        add(done, share);
        runs = select(done, zero, runs);
      }
      if (!any(runs > zero)) return;
      if (any(done) && !task_.by_thesis) {
        static_cast<void>(
            measure(plan, task_.shape.rows.balance, solve_.progress.level, s_));
      }
      done = (runs > zero) & advance();
    }
  }

  [[nodiscard]] Mask<F> advance() {
    if (task_.by_thesis) {
      return advance_thesis(*task_.plan, *task_.thesis, task_.settings, s_, solve_);
    }
    return advance_lanes(*task_.plan, task_.shape, task_.settings, s_, solve_);
  }

  void add(const Mask<F>& done, const F& share) {
    const Plan& plan = *task_.plan;
    if (task_.by_thesis) {
      static_cast<void>(
          finish_thesis(plan, *task_.thesis, task_.settings, done, s_, solve_));
    } else {
      static_cast<void>(
          finish_lanes(plan, task_.shape, task_.settings, done, s_, solve_));
    }
    const Progress<F>& p = solve_.progress;
    figures_.iterations =
        select(done, figures_.iterations + p.iterations, figures_.iterations);
    figures_.capped = select(done, max(figures_.capped, p.capped), figures_.capped);
    add_to_mean(plan, task_.shape.rows.balance, share, done, s_, sums_);
  }

  void load_mean() {
    for (int lane = 0; lane < count_; ++lane) {
      const FadeJobs::Mean mean = jobs_.mean(lane);
      load_targets(*task_.plan, mean.targets, lane, s_);
      for (std::size_t k = 0; k < sums_.firmness.size(); ++k) {
        lane_of(sums_.firmness[k], lane) = mean.firmness[k];
      }
    }
  }

  void finish() {
    const Plan& plan = *task_.plan;
    const bool balance = task_.shape.rows.balance;
    const Mask<F> used = used_ > num<F>(0.5);
    load_mean();
    take_mean(plan, s_, sums_);
    close_mean(plan, task_.shape, task_.settings, used, s_, sums_);
    if (balance) settle_mean(plan, task_.shape, task_.settings, used, s_, sums_);
    // aim_at_mean() has overwritten the target rotations.
    load_mean();
    s_.com_target = sums_.com_target;
    const F last = num<F>(task_.shape.last_level);
    figures_.balance = measure(plan, balance, last, s_).balance;
    spread_posture(plan, s_);
  }

  FadeJobs& jobs_;
  Lanes<F>& s_;
  Solve<F>& solve_;
  FadeSums<F>& sums_;
  LaneTask task_;
  LaneFigures<F> figures_;
  F used_ = num<F>(0);
  std::array<int, Width> passes_{};
  int count_ = 0;
  int max_passes_ = 0;
};

}  // namespace marey::retarget
