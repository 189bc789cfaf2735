// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "retarget/adapt/plan/adapt_plan.h"
#include "retarget/base/lanes.h"

namespace marey::retarget {

/// Parameters of a lane's goal; their meaning depends on GoalKind. Lengths are in units,
/// in the lane's own frame (origin: root of the reference posture).
template <class F>
struct LaneGoal {
  Vec3<F> a;         ///< Position; lower corner; unused.
  Vec3<F> b;         ///< Upper corner; the other point, in the frame of its joint.
  Quat<F> rotation;  ///< World from joint, for an orientation or a support.
  F distance{};
};

template <class F>
struct LanePoint {
  Vec3<F> in_joint;  ///< Constrained point.
  LaneGoal<F> goal;
  F active{};         ///< 1 or 0.
  F requested{};      ///< 1: active. The thesis' method has one level active at a time.
  F firm{};           ///< 1: the point is on a standing foot.
  F weight{};         ///< For blending: importance divided by the largest; otherwise 1.
  F per_precision{};  ///< 1 / precision.
  Vec3<F> place;      ///< Current position in the world.
  Vec3<F> target;
  Vec3<F> error;  ///< Target minus position; for an orientation a rotation vector.
  Vec3<F> held;   ///< Position to hold once its level is done,
  F holds{};      ///< flag: 1 if held.
};

/// State of as many bodies as F has lanes, all with the same plan.
template <class F>
struct Lanes {
  // Bodies.
  std::vector<Vec3<F>> offset;
  std::vector<Vec3<F>> hinge;
  std::vector<F> mass;                 ///< In the order of Plan::masses, in any unit.
  std::vector<Vec3<F>> mass_in_joint;  ///< In the order of Plan::masses.
  std::vector<F> carried_mass;  ///< Per joint: mass of all joints attached rigidly to it.
  std::vector<Vec3<F>> carried_in_joint;  ///< Centre of that mass.
  std::vector<Quat<F>> limit_from_joint;
  std::vector<Vec3<F>> limit_min;
  std::vector<Vec3<F>> limit_max;
  std::vector<Quat<F>> rest_from_joint;  ///< For limited joints: local rotation in the
                                         ///< T-pose.
  F min_trunk_thigh_cos{};
  F straight_knee_cos{};
  // Postures: rotations and positions in the world. With supports, the reference is the
  // posture on the footprints, computed from the given one
  // (retarget/adapt/kernel/adapt_ground.h).
  std::vector<Quat<F>> given_rotation;
  std::vector<Vec3<F>> given_place;
  std::vector<Quat<F>> given_local;
  std::vector<Quat<F>> reference_rotation;
  std::vector<Vec3<F>> reference_place;
  std::vector<Quat<F>> rotation;
  std::vector<Vec3<F>> place;
  std::vector<Quat<F>> best_rotation;
  std::vector<Vec3<F>> best_place;
  std::vector<Quat<F>> kept_rotation;  ///< Copy of the posture while balance settles.
  std::vector<Vec3<F>> kept_place;
  std::vector<Quat<F>> local;  ///< Rotation of each joint in its parent, when final.
  std::vector<Quat<F>> turn;   ///< Rotation since the start of the step, accumulated from
                               ///< the root.
  // Targets.
  std::vector<LanePoint<F>> points;
  F com_from_reference{};  ///< 1: the target is the position in the reference.
  Vec3<F> com;
  Vec3<F> com_target;
  Vec3<F> given_com_target;
  F com_travel{};  ///< Distance of the target from the position in the reference, as
                   ///< defined by `balance`.
  F balance{};     ///< 1: the centre of mass has a target.
  F vertical{};    ///< 1: the target includes the height.
  F balance_precision{};
  F threshold{};  ///< Threshold for changes of the error.
  F balance_threshold{};
  F mobility{};     ///< Mobility of the root and of all joints outside limbs, 0 to 1.
  F root_weight{};  ///< Vertical share of the root's translation.
  F root_weight_on_floor{};
  // Workspace of the whole-body step.
  std::vector<F> run_weight;             ///< Sums over joints from the root: weights,
  std::vector<Vec3<F>> run_place;        ///< weighted positions,
  std::vector<F> run_square;             ///< and their products: xx xy xz yy yz zz.
  std::vector<Vec3<F>> run_lever;        ///< Sums of levers of the centre of mass,
  std::vector<F> run_lever_place;        ///< and their products with positions, 9 each.
  std::vector<Quat<F>> reference_local;  ///< Rotations of joints in their parents.
  std::vector<Vec3<F>> strayed;  ///< Rotation of each joint from the reference, in the
                                 ///< world.
  std::vector<Vec3<F>> lever;    ///< Lever of each joint on the centre of mass.
  std::vector<F> below_mass;
  std::vector<Vec3<F>> below_moment;
  /// Hinge axis of each limb: in the frame of its lower joint, from the reference
  /// posture, and in the world.
  std::vector<Vec3<F>> axis_in_lower;
  std::vector<Vec3<F>> axis;
  std::vector<F> blocks;       ///< Blocks of the normal equations, 9 numbers each.
  std::vector<Vec3<F>> right;  ///< Right-hand side, then the solution.

  explicit Lanes(const Plan& plan);
};

/// Returns one lane of a number. A batch is a register of scalars, and compilers permit
/// aliasing of register types. Precondition: `lane` is below the number of lanes.
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
