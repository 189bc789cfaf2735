// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_limits.h"
#include "retarget/adapt/kernel/adapt_measure.h"
#include "retarget/adapt/algebra/block_cholesky.h"
#include "retarget/adapt/kernel/limb_closure.h"

/// One damped Gauss-Newton step of the whole body, in dual form.
///
/// The targets' rows J are the derivatives of their points by the rotations of the
/// joints. The smallest rotations dq that remove the errors e are J' (J J' + D)^-1 e
/// (Wampler 1986; Baerlocher and Boulic 2004 for priorities): the size of the system is
/// the number of targets. Ball joints give its blocks a closed form: with r_a = p_a - P_i
/// from joint i to point a, the joint adds (r_a . r_b) 1 - r_b r_a'. The sum over a run
/// of joints needs only the sums of 1, P_i and P_i P_i' along the run that two points of
/// a tree share. dq is never stored as a vector: joint i rotates by the sum of r_a x
/// lambda_a.
///
/// Priorities result from the damping D alone. Rows with very small damping (supports,
/// balance, points held from higher levels) are met independent of the others (by the
/// first block row of the system); the other rows share the remaining freedom.
namespace marey::retarget {

/// Returns the mobility of joint `i` for targets up to `level`. Balance uses all joints
/// except the joints of targets of later levels only.
template <class F>
[[nodiscard]] inline F own_share(const Plan& plan,
                                 std::size_t i,
                                 const F& level,
                                 const Lanes<F>& s) {
  const F share = plan.in_limb[i] ? num<F>(1) : s.mobility;
  if (plan.turns_from[i] <= 1) return share;
  return select(num<F>(plan.turns_from[i]) <= level, share, num<F>(0));
}

/// Upward share of the root's translation while balance moves it horizontally, because a
/// straight leg permits no other movement.
inline constexpr double kRiseForBalance = 0.1;

/// Returns the mobility of the root along x, y and z. Balance uses the full weight of the
/// root along its axes, independent of the mobility of the trunk.
template <class F>
[[nodiscard]] inline Vec3<F> root_share(const Lanes<F>& s) {
  const F floor = max(s.mobility, s.balance) * s.root_weight_on_floor;
  const F rises = s.balance * max(s.vertical, num<F>(kRiseForBalance));
  return {floor, max(s.mobility, rises) * s.root_weight, floor};
}

/// Computes sums along the path from the root to each live joint, over rotating joints.
/// Positions are relative to the current root: footprints may have moved the body far
/// from the reference, and the squares of far positions would cancel the differences of
/// near ones.
template <class F>
void sum_runs(const Plan& plan, bool balance, const F& level, Lanes<F>& s) {
  const F zero = num<F>(0);
  for (const int joint : plan.live) {
    const auto i = static_cast<std::size_t>(joint);
    const bool turns = plan.turning[i] == Turning::kBall;
    F weight = zero;
    Vec3<F> place{zero, zero, zero};
    F square[6] = {zero, zero, zero, zero, zero, zero};
    if (joint > 0) {
      const auto p = static_cast<std::size_t>(plan.parent[i]);
      weight = s.run_weight[p];
      place = s.run_place[p];
      for (std::size_t n = 0; n < 6; ++n) square[n] = s.run_square[6 * p + n];
    }
    const Vec3<F> at = s.place[i] - s.place[0];
    const F own = own_share(plan, i, level, s);
    if (turns) {
      const Vec3<F> weighted = own * at;
      weight = weight + own;
      place += weighted;
      square[0] = square[0] + weighted.x * at.x;
      square[1] = square[1] + weighted.x * at.y;
      square[2] = square[2] + weighted.x * at.z;
      square[3] = square[3] + weighted.y * at.y;
      square[4] = square[4] + weighted.y * at.z;
      square[5] = square[5] + weighted.z * at.z;
    }
    s.run_weight[i] = weight;
    s.run_place[i] = place;
    for (std::size_t n = 0; n < 6; ++n) s.run_square[6 * i + n] = square[n];
    if (!balance) continue;
    // Derivative of the centre of mass, over the whole mass, by a rotation of this joint.
    const Vec3<F> lever = s.below_moment[i] - s.below_mass[i] * s.place[i];
    s.lever[i] = lever;
    const auto p = joint > 0 ? static_cast<std::size_t>(plan.parent[i]) : 0;
    Vec3<F> run = joint > 0 ? s.run_lever[p] : Vec3<F>{zero, zero, zero};
    const Vec3<F> weighted = own * lever;
    if (turns) run += weighted;
    s.run_lever[i] = run;
    const F outer[9] = {weighted.x * at.x,
                        weighted.x * at.y,
                        weighted.x * at.z,
                        weighted.y * at.x,
                        weighted.y * at.y,
                        weighted.y * at.z,
                        weighted.z * at.x,
                        weighted.z * at.y,
                        weighted.z * at.z};
    for (std::size_t n = 0; n < 9; ++n) {
      const F before = joint > 0 ? s.run_lever_place[9 * p + n] : zero;
      s.run_lever_place[9 * i + n] = turns ? before + outer[n] : before;
    }
  }
}

/// Returns the same sums over a shared run alone.
template <class F>
struct RunSums {
  F weight;
  Vec3<F> place;
  F square[6];
};

template <class F>
[[nodiscard]] inline RunSums<F> sums_of(const SharedChain& run, const Lanes<F>& s) {
  const auto low = static_cast<std::size_t>(run.lowest);
  RunSums<F> out{s.run_weight[low], s.run_place[low], {}};
  for (std::size_t n = 0; n < 6; ++n) out.square[n] = s.run_square[6 * low + n];
  if (run.above >= 0) {
    const auto above = static_cast<std::size_t>(run.above);
    out.weight = out.weight - s.run_weight[above];
    out.place -= s.run_place[above];
    for (std::size_t n = 0; n < 6; ++n) {
      out.square[n] = out.square[n] - s.run_square[6 * above + n];
    }
  }
  return out;
}

/// Returns the sum over a run of (r_a . r_b) 1 - r_b r_a'; for orientations of r x . and
/// 1.
template <class F>
void shared_block(const PointPlan& pa,
                  const PointPlan& pb,
                  const Vec3<F>& a,
                  const Vec3<F>& b,
                  const RunSums<F>& u,
                  F (&block)[9]) {
  const F zero = num<F>(0);
  for (F& x : block) x = zero;
  const F* q = u.square;
  const Vec3<F>& m = u.place;
  const F& w = u.weight;
  if (pa.turns_only() && pb.turns_only()) {
    block[0] = block[4] = block[8] = w;
    return;
  }
  if (pa.turns_only() || pb.turns_only()) {
    // For the point r: -[r]x on its side, 1 on the other.
    const Vec3<F>& point = pa.turns_only() ? b : a;
    const Vec3<F> r = w * point - m;
    const F sign = pa.turns_only() ? num<F>(1) : num<F>(-1);
    block[1] = -(sign * r.z);
    block[2] = sign * r.y;
    block[3] = sign * r.z;
    block[5] = -(sign * r.x);
    block[6] = -(sign * r.y);
    block[7] = sign * r.x;
    return;
  }
  const Vec3<F> wb = w * b - m;
  // Outer product, rows of b: sum (b - P)(a - P)' = (w b - m) a' - b m' + sum P P'.
  block[0] = wb.x * a.x - b.x * m.x + q[0];
  block[1] = wb.x * a.y - b.x * m.y + q[1];
  block[2] = wb.x * a.z - b.x * m.z + q[2];
  block[3] = wb.y * a.x - b.y * m.x + q[1];
  block[4] = wb.y * a.y - b.y * m.y + q[3];
  block[5] = wb.y * a.z - b.y * m.z + q[4];
  block[6] = wb.z * a.x - b.z * m.x + q[2];
  block[7] = wb.z * a.y - b.z * m.y + q[4];
  block[8] = wb.z * a.z - b.z * m.z + q[5];
  const F trace = block[0] + block[4] + block[8];
  for (F& x : block) x = -x;
  block[0] = block[0] + trace;
  block[4] = block[4] + trace;
  block[8] = block[8] + trace;
}

/// Returns the derivative of a target's rows by a rotation of joint `i` about the unit
/// `axis`.
template <class F>
[[nodiscard]] inline Vec3<F> moved_by(const PointPlan& point,
                                      const Vec3<F>& place,
                                      const Vec3<F>& joint,
                                      const Vec3<F>& axis) {
  return point.turns_only() ? axis : cross(axis, place - joint);
}

template <class F>
inline void add_outer(const Vec3<F>& a, const Vec3<F>& b, F* block) {
  block[0] = block[0] + a.x * b.x;
  block[1] = block[1] + a.x * b.y;
  block[2] = block[2] + a.x * b.z;
  block[3] = block[3] + a.y * b.x;
  block[4] = block[4] + a.y * b.y;
  block[5] = block[5] + a.y * b.z;
  block[6] = block[6] + a.z * b.x;
  block[7] = block[7] + a.z * b.y;
  block[8] = block[8] + a.z * b.z;
}

/// Order of the system's rows: supports, then balance if any, then the others.
struct RowOrder {
  int supports = 0;
  bool balance = false;
  [[nodiscard]] int row_of(int point) const {
    return point < supports || !balance ? point : point + 1;
  }
};

template <class F>
void form_point_blocks(const Plan& plan, const RowOrder& rows, int side, Lanes<F>& s) {
  const Vec3<F> root = root_share(s);
  const int n = static_cast<int>(plan.points.size());
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b) {
      const SharedChain& run = plan.shared[static_cast<std::size_t>(a * n + b)];
      const auto ia = static_cast<std::size_t>(a);
      const auto ib = static_cast<std::size_t>(b);
      F block[9];
      if (run.lowest >= 0) {
        shared_block(plan.points[ia],
                     plan.points[ib],
                     s.points[ia].place - s.place[0],
                     s.points[ib].place - s.place[0],
                     sums_of(run, s),
                     block);
      } else {
        for (F& x : block) x = num<F>(0);
      }
      if (run.root && !plan.points[ia].turns_only() && !plan.points[ib].turns_only()) {
        block[0] = block[0] + root.x;
        block[4] = block[4] + root.y;
        block[8] = block[8] + root.z;
      }
      F* out = &s.blocks[static_cast<std::size_t>(
          9 * (rows.row_of(a) * side + rows.row_of(b)))];
      for (std::size_t i = 0; i < 9; ++i) out[i] = block[i];
    }
  }
}

/// Block of the centre of mass with itself.
template <class F>
void form_own_balance_block(
    const Plan& plan, const RowOrder& rows, int side, const F& level, Lanes<F>& s) {
  const int row = rows.supports;
  const F zero = num<F>(0);
  F own[9] = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    if (plan.turning[i] != Turning::kBall) continue;
    const Vec3<F>& v = s.lever[i];
    const Vec3<F> weighted = own_share(plan, i, level, s) * v;
    const F square = dot(weighted, v);
    F outer[9] = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
    add_outer(weighted, v, outer);
    for (std::size_t e = 0; e < 9; ++e) own[e] = own[e] - outer[e];
    own[0] = own[0] + square;
    own[4] = own[4] + square;
    own[8] = own[8] + square;
  }
  const Vec3<F> root = root_share(s);
  own[0] = own[0] + root.x;
  own[4] = own[4] + root.y;
  own[8] = own[8] + root.z;
  F* out = &s.blocks[static_cast<std::size_t>(9 * (row * side + row))];
  for (std::size_t e = 0; e < 9; ++e) out[e] = own[e];
}

/// Computes the blocks of the centre of mass with itself and with every target.
template <class F>
void form_balance_blocks(
    const Plan& plan, const RowOrder& rows, int side, const F& level, Lanes<F>& s) {
  form_own_balance_block(plan, rows, side, level, s);
  const int n = static_cast<int>(plan.points.size());
  const int row = rows.supports;
  const F zero = num<F>(0);
  const Vec3<F> root = root_share(s);
  for (int k = 0; k < n; ++k) {
    const PointPlan& point = plan.points[static_cast<std::size_t>(k)];
    const Vec3<F> p = s.points[static_cast<std::size_t>(k)].place - s.place[0];
    const auto low =
        static_cast<std::size_t>(point.chain.empty() ? 0 : point.chain.front());
    const int above = plan.parent[static_cast<std::size_t>(point.top)];
    Vec3<F> v = s.run_lever[low];
    F vp[9];
    for (std::size_t e = 0; e < 9; ++e) vp[e] = s.run_lever_place[9 * low + e];
    // A target without joints has zero blocks with all others.
    if (point.chain.empty()) {
      v = {zero, zero, zero};
      for (F& x : vp) x = zero;
    } else if (above >= 0) {
      const auto up = static_cast<std::size_t>(above);
      v -= s.run_lever[up];
      for (std::size_t e = 0; e < 9; ++e) vp[e] = vp[e] - s.run_lever_place[9 * up + e];
    }
    // Rows of the point: (r . v) 1 - v r' = J_p J_c', with r = p - P.
    F block[9];
    if (point.turns_only()) {
      // 1 times -[v]x transposed.
      block[0] = block[4] = block[8] = zero;
      block[1] = -v.z;
      block[2] = v.y;
      block[3] = v.z;
      block[5] = -v.x;
      block[6] = -v.y;
      block[7] = v.x;
    } else {
      block[0] = vp[0] - v.x * p.x;
      block[1] = vp[1] - v.x * p.y;
      block[2] = vp[2] - v.x * p.z;
      block[3] = vp[3] - v.y * p.x;
      block[4] = vp[4] - v.y * p.y;
      block[5] = vp[5] - v.y * p.z;
      block[6] = vp[6] - v.z * p.x;
      block[7] = vp[7] - v.z * p.y;
      block[8] = vp[8] - v.z * p.z;
      const F dots = -(block[0] + block[4] + block[8]);
      block[0] = block[0] + dots;
      block[4] = block[4] + dots;
      block[8] = block[8] + dots;
      if (point.moves_root) {
        block[0] = block[0] + root.x;
        block[4] = block[4] + root.y;
        block[8] = block[8] + root.z;
      }
    }
    // In the lower triangle the later row comes first.
    const int other = rows.row_of(k);
    F* to = &s.blocks[static_cast<std::size_t>(
        9 * (other > row ? other * side + row : row * side + other))];
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        to[3 * r + c] = other > row ? block[3 * r + c] : block[3 * c + r];
      }
    }
  }
}

/// Adds hinges: each rotates about one axis and contributes the product of its
/// derivatives.
template <class F>
void add_hinges(
    const Plan& plan, const RowOrder& rows, int side, const F& level, Lanes<F>& s) {
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) {
    const auto j = static_cast<std::size_t>(plan.limbs[l].lower);
    if (plan.turning[j] != Turning::kHinge) continue;
    s.axis[l] = limb_axis(plan.limbs[l], s, static_cast<int>(l));
    const int begin = plan.through_begin[j];
    const int end = plan.through_begin[j + 1];
    Vec3<F> com = rows.balance ? cross(s.axis[l], s.lever[j]) : Vec3<F>{};
    if (rows.balance) com = own_share(plan, j, level, s) * com;
    if (rows.balance) {
      const int row = rows.supports;
      add_outer(com, com, &s.blocks[static_cast<std::size_t>(9 * (row * side + row))]);
    }
    for (int x = begin; x < end; ++x) {
      const int a = plan.through[static_cast<std::size_t>(x)];
      const auto ia = static_cast<std::size_t>(a);
      const Vec3<F> ga =
          moved_by(plan.points[ia], s.points[ia].place, s.place[j], s.axis[l]);
      for (int y = begin; y <= x; ++y) {
        const int b = plan.through[static_cast<std::size_t>(y)];
        const auto ib = static_cast<std::size_t>(b);
        const Vec3<F> gb =
            moved_by(plan.points[ib], s.points[ib].place, s.place[j], s.axis[l]);
        add_outer(ga,
                  gb,
                  &s.blocks[static_cast<std::size_t>(
                      9 * (rows.row_of(a) * side + rows.row_of(b)))]);
      }
      if (!rows.balance) continue;
      const int row = rows.supports;
      const int other = rows.row_of(a);
      if (other > row) {
        add_outer(ga, com, &s.blocks[static_cast<std::size_t>(9 * (other * side + row))]);
      } else {
        add_outer(com, ga, &s.blocks[static_cast<std::size_t>(9 * (row * side + other))]);
      }
    }
  }
}

}  // namespace marey::retarget
