// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "retarget/adapt_plan.h"
#include "retarget/lanes.h"

namespace marey::retarget {

/// What a lane's goal is made from; the meaning depends on GoalKind. Lengths in units, in
/// the lane's own frame (the root of the reference posture is its origin).
template <class F>
struct LaneGoal {
  Vec3<F> a;         ///< Place; low corner; unused.
  Vec3<F> b;         ///< High corner; the other point, in its joint's frame.
  Quat<F> rotation;  ///< World from joint, of an orientation or a support.
  F distance{};
};

template <class F>
struct LanePoint {
  Vec3<F> in_joint;  ///< The constrained point.
  LaneGoal<F> goal;
  F active{};         ///< 1 or 0.
  F asked{};          ///< 1: active; the thesis' method has one level active at a time.
  F firm{};           ///< 1: it is on a foot that stands.
  F weight{};         ///< Of blending: importance over the largest; 1 otherwise.
  F per_precision{};  ///< One over the precision.
  Vec3<F> place;      ///< In the world, at this moment.
  Vec3<F> target;
  Vec3<F> error;  ///< Target minus place; of an orientation, a rotation vector.
  Vec3<F> held;   ///< Where it is kept once its level is done,
  F holds{};      ///< then 1.
};

/// The state of as many bodies as F has lanes, all of one plan.
template <class F>
struct Lanes {
  // Bodies.
  std::vector<Vec3<F>> offset;
  std::vector<Vec3<F>> hinge;
  std::vector<F> mass;                 ///< As Plan::masses, any unit.
  std::vector<Vec3<F>> mass_in_joint;  ///< Likewise.
  std::vector<F> carried_mass;         ///< Per joint, of all that hangs rigidly from it.
  std::vector<Vec3<F>> carried_in_joint;  ///< Its centre.
  std::vector<Quat<F>> limit_from_joint;
  std::vector<Vec3<F>> limit_min;
  std::vector<Vec3<F>> limit_max;
  std::vector<Quat<F>> rest_from_joint;  ///< Of limited joints: local in the T-pose.
  F least_trunk_thigh_cos{};
  F straight_knee_cos{};
  // Postures: rotations and places in the world. With supports the reference is what
  // stands on the footprints, made from what was given (retarget/adapt_ground.h).
  std::vector<Quat<F>> given_rotation;
  std::vector<Vec3<F>> given_place;
  std::vector<Quat<F>> given_local;
  std::vector<Quat<F>> reference_rotation;
  std::vector<Vec3<F>> reference_place;
  std::vector<Quat<F>> rotation;
  std::vector<Vec3<F>> place;
  std::vector<Quat<F>> best_rotation;
  std::vector<Vec3<F>> best_place;
  std::vector<Quat<F>> kept_rotation;  ///< While balance settles.
  std::vector<Vec3<F>> kept_place;
  std::vector<Quat<F>> local;  ///< Of each joint in its parent, once it is done.
  std::vector<Quat<F>> turn;   ///< Since the step's begin, accumulated from the root.
  // Wishes.
  std::vector<LanePoint<F>> points;
  F com_from_reference{};  ///< 1: the wanted place is the reference's own.
  Vec3<F> com;
  Vec3<F> com_target;
  Vec3<F> given_com_target;
  F com_travel{};  ///< From the reference's own, as `balance` measures it.
  F balance{};     ///< 1: the centre of mass is wanted somewhere.
  F vertical{};    ///< 1: in height, too.
  F balance_precision{};
  F threshold{};  ///< Of changes of error.
  F balance_threshold{};
  F mobility{};     ///< Of all joints that are in no limb, and of the root: 0 to 1.
  F root_weight{};  ///< Vertical: the root's share of its travel.
  F root_weight_on_floor{};
  // Workspace of the whole-body step.
  std::vector<F> run_weight;             ///< Sums over joints from the root: of weights,
  std::vector<Vec3<F>> run_place;        ///< of weighted places,
  std::vector<F> run_square;             ///< and of their products: xx xy xz yy yz zz.
  std::vector<Vec3<F>> run_lever;        ///< Of levers of the centre of mass,
  std::vector<F> run_lever_place;        ///< and of their products with places, 9 each.
  std::vector<Quat<F>> reference_local;  ///< Of joints in their parents.
  std::vector<Vec3<F>> strayed;  ///< How each joint has turned from there, in the world.
  std::vector<Vec3<F>> lever;    ///< Of each joint over the centre of mass.
  std::vector<F> below_mass;
  std::vector<Vec3<F>> below_moment;
  /// Of each limb's hinge in its lower joint's frame, from the reference posture, and in
  /// the world.
  std::vector<Vec3<F>> axis_in_lower;
  std::vector<Vec3<F>> axis;
  std::vector<F> blocks;       ///< Of the normal equations, 9 each.
  std::vector<Vec3<F>> right;  ///< Right-hand side, then its solution.

  explicit Lanes(const Plan& plan);
};

/// One lane of a number. A batch is a register's worth of scalars and nothing else, and
/// compilers declare register types so that they may alias them.
/// Precondition: `lane` is below the number of lanes.
template <class F>
[[nodiscard]] inline Scalar<F>& lane_of(F& x, int lane) {
  static_assert(sizeof(F) % sizeof(Scalar<F>) == 0);
  return reinterpret_cast<Scalar<F>*>(&x)[lane];
}

template <class F>
Lanes<F>::Lanes(const Plan& plan) {
  const std::size_t n = plan.parent.size();
  const std::size_t blocks_per_side = plan.points.size() + 1;
  offset.resize(n);
  hinge.resize(plan.limbs.size());
  mass.resize(plan.masses.size());
  mass_in_joint.resize(plan.masses.size());
  carried_mass.resize(n);
  carried_in_joint.resize(n);
  limit_from_joint.resize(n, identity<F>());
  limit_min.resize(n);
  limit_max.resize(n);
  rest_from_joint.resize(n, identity<F>());
  if (plan.has_supports) {
    given_rotation.resize(n, identity<F>());
    given_place.resize(n);
    given_local.resize(n, identity<F>());
  }
  reference_rotation.resize(n, identity<F>());
  reference_place.resize(n);
  rotation.resize(n, identity<F>());
  place.resize(n);
  best_rotation.resize(n, identity<F>());
  best_place.resize(n);
  kept_rotation.resize(n, identity<F>());
  kept_place.resize(n);
  local.resize(n, identity<F>());
  turn.resize(n, identity<F>());
  points.resize(plan.points.size());
  run_weight.resize(n);
  run_place.resize(n);
  run_square.resize(6 * n);
  run_lever.resize(n);
  run_lever_place.resize(9 * n);
  reference_local.resize(n, identity<F>());
  strayed.resize(n);
  lever.resize(n);
  below_mass.resize(n);
  below_moment.resize(n);
  axis_in_lower.resize(plan.limbs.size());
  axis.resize(plan.limbs.size());
  blocks.resize(9 * blocks_per_side * blocks_per_side);
  right.resize(blocks_per_side);
}

}  // namespace marey::retarget
