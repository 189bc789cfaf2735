// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "retarget/adapt/kernel/adapt_lanes.h"
#include "retarget/adapt/kernel/adapt_limits.h"
#include "retarget/adapt/kernel/adapt_measure.h"

/// Reads and writes the numbers of lanes. Input is only copied: kernels for wide vectors
/// must not compute in plain scalars, because a linker may use their instructions in the
/// whole program (one inline function exists once per program).
namespace marey::retarget {

/// Reads packed numbers into one lane (retarget/adapt/plan/adapt_numbers.h).
template <class F>
class Unpacker {
 public:
  Unpacker(const float* from, int lane) : from_(from), lane_(lane) {}
  void get(F& x) { lane_of(x, lane_) = *from_++; }
  void get(Vec3<F>& v) {
    get(v.x);
    get(v.y);
    get(v.z);
  }
  void get(Quat<F>& q) {
    get(q.w);
    get(q.x);
    get(q.y);
    get(q.z);
  }

 private:
  const float* from_;
  int lane_;
};

template <class F>
void load_body(const Plan& plan, const float* packed, int lane, Lanes<F>& s) {
  Unpacker<F> from(packed, lane);
  for (std::size_t j = 0; j < plan.parent.size(); ++j) from.get(s.offset[j]);
  for (std::size_t l = 0; l < plan.limbs.size(); ++l) from.get(s.hinge[l]);
  for (const int joint : plan.limited) {
    const auto j = static_cast<std::size_t>(joint);
    from.get(s.limit_from_joint[j]);
    from.get(s.rest_from_joint[j]);
    from.get(s.limit_min[j]);
    from.get(s.limit_max[j]);
  }
  from.get(s.min_trunk_thigh_cos);
  from.get(s.straight_knee_cos);
  for (std::size_t m = 0; m < plan.masses.size(); ++m) {
    from.get(s.mass[m]);
    from.get(s.mass_in_joint[m]);
  }
}

template <class F>
void load_posture(const Plan& plan, const float* packed, int lane, Lanes<F>& s) {
  Unpacker<F> from(packed, lane);
  for (std::size_t j = 0; j < plan.parent.size(); ++j) from.get(s.reference_local[j]);
}

template <class F>
void load_targets(const Plan& plan, const float* packed, int lane, Lanes<F>& s) {
  Unpacker<F> from(packed, lane);
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    LanePoint<F>& p = s.points[k];
    from.get(p.in_joint);
    from.get(p.goal.a);
    from.get(p.goal.b);
    from.get(p.goal.rotation);
    from.get(p.goal.distance);
    from.get(p.active);
    from.get(p.weight);
    from.get(p.per_precision);
    // Supports come first.
    for (const int support : plan.points[k].firm_under) {
      const auto i = static_cast<std::size_t>(support);
      if (support == plan.points[k].firm_under.front()) lane_of(p.firm, lane) = 0;
      if (lane_of(s.points[i].active, lane) > 0) lane_of(p.firm, lane) = 1;
    }
  }
}

template <class F>
void load_balance(const float* packed, int lane, Lanes<F>& s) {
  Unpacker<F> from(packed, lane);
  from.get(s.balance);
  from.get(s.vertical);
  from.get(s.balance_precision);
  from.get(s.root_weight);
  from.get(s.root_weight_on_floor);
  from.get(s.com_from_reference);
  from.get(s.com_target);
  from.get(s.threshold);
  from.get(s.balance_threshold);
}

/// Computes the reference postures of the lanes in `mask`: positions, and the mass that
/// each live joint carries. Roots are at the origin.
template <class F>
void stand_reference(const Plan& plan, bool balance, const Mask<F>& mask, Lanes<F>& s) {
  const F zero = num<F>(0);
  const Vec3<F> origin{zero, zero, zero};
  for (std::size_t j = 0; j < plan.parent.size(); ++j) {
    Quat<F> rotation = s.reference_local[j];
    Vec3<F> place = origin;
    if (plan.parent[j] >= 0) {
      const auto p = static_cast<std::size_t>(plan.parent[j]);
      rotation = s.reference_rotation[p] * rotation;
      place = s.reference_place[p] + rotate(s.reference_rotation[p], s.offset[j]);
    }
    s.reference_rotation[j] = select(mask, rotation, s.reference_rotation[j]);
    s.reference_place[j] = select(mask, place, s.reference_place[j]);
    if (!plan.has_supports) continue;
    s.given_rotation[j] = select(mask, rotation, s.given_rotation[j]);
    s.given_place[j] = select(mask, place, s.given_place[j]);
    s.given_local[j] = select(mask, s.reference_local[j], s.given_local[j]);
  }
  if (plan.has_limits) widen_limits(plan, mask, s);
  if (!balance) return;
  const auto& given_rotation =
      plan.has_supports ? s.given_rotation : s.reference_rotation;
  const auto& given_place = plan.has_supports ? s.given_place : s.reference_place;
  // All values are recomputed from the lane's own numbers, so lanes outside the mask get
  // the same values.
  F total = zero;
  for (const int j : plan.live) {
    s.carried_mass[static_cast<std::size_t>(j)] = zero;
    s.carried_in_joint[static_cast<std::size_t>(j)] = origin;
  }
  for (std::size_t m = 0; m < plan.masses.size(); ++m) {
    const auto j = static_cast<std::size_t>(plan.masses[m].joint);
    const auto c = static_cast<std::size_t>(plan.masses[m].carried_by);
    Vec3<F> in_carrier = s.mass_in_joint[m];
    if (c != j) {
      const Vec3<F> at = given_place[j] + rotate(given_rotation[j], in_carrier);
      in_carrier = rotate(conjugate(given_rotation[c]), at - given_place[c]);
    }
    s.carried_mass[c] = s.carried_mass[c] + s.mass[m];
    s.carried_in_joint[c] += s.mass[m] * in_carrier;
    total = total + s.mass[m];
  }
  const F per_total = num<F>(1) / max(total, num<F>(1e-9));
  for (const int joint : plan.live) {
    const auto j = static_cast<std::size_t>(joint);
    s.carried_in_joint[j] =
        (num<F>(1) / max(s.carried_mass[j], num<F>(1e-9))) * s.carried_in_joint[j];
    s.carried_mass[j] = per_total * s.carried_mass[j];
  }
  // The reference balances its own body without loads (thesis 7.2.1).
  Vec3<F> com = origin;
  F own = zero;
  for (std::size_t m = 0; m < plan.own_masses; ++m) {
    const auto j = static_cast<std::size_t>(plan.masses[m].joint);
    com += s.mass[m] * (given_place[j] + rotate(given_rotation[j], s.mass_in_joint[m]));
    own = own + s.mass[m];
  }
  com = (num<F>(1) / max(own, num<F>(1e-9))) * com;
  s.com_target = select(mask & (s.com_from_reference > num<F>(0.5)), com, s.com_target);
  s.given_com_target = select(mask, s.com_target, s.given_com_target);
  const Vec3<F> travel = s.com_target - com;
  const F along = travel.x * travel.x + travel.z * travel.z;
  const F far = sqrt(along + s.vertical * travel.y * travel.y);
  s.com_travel = select(mask, far, s.com_travel);
}

/// Computes every joint of a posture whose live joints are done: the positions of rigidly
/// attached joints, and the rotations of all joints in their parents.
template <class F>
void spread_posture(const Plan& plan, Lanes<F>& s) {
  for (const int j : plan.rest) {
    const auto i = static_cast<std::size_t>(j);
    const auto p = static_cast<std::size_t>(plan.parent[i]);
    s.rotation[i] = s.rotation[p] * s.reference_local[i];
    place_joint(plan, s, j);
  }
  for (std::size_t i = 0; i < plan.parent.size(); ++i) {
    const bool root = plan.parent[i] < 0;
    s.local[i] =
        trued(root ? s.rotation[i]
                   : conjugate(s.rotation[static_cast<std::size_t>(plan.parent[i])]) *
                         s.rotation[i]);
  }
}

}  // namespace marey::retarget
