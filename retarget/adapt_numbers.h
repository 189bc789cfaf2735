// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "retarget/adapt_lanes.h"
#include "retarget/adapt_solve.h"

namespace marey::retarget {

/// The numbers of a body, in its own unit. Precondition: as make_plan().
[[nodiscard]] BodyNumbers body_numbers(const Character& character, const Plan& plan);

/// World rotation of each joint's frame in the T-pose (Character::t_pose_from_joint).
[[nodiscard]] std::vector<glm::dquat> t_pose_rotations(const Character& character);

/// One wish at one moment, in world metres.
struct WishNumbers {
  glm::dvec3 in_joint{0.0};    ///< The point, in its joint's frame.
  glm::dvec3 a_in_world{0.0};  ///< Place; low corner; footprint.
  glm::dvec3 b{
      0.0};  ///< High corner, in the world; the other point, in its joint's frame.
  glm::dquat world_from_joint{1.0, 0.0, 0.0, 0.0};
  double distance_m = 0.0;
  bool active = false;
  double weight = 1.0;
  double precision_m = 0.001;
};

struct BalanceNumbers {
  bool wanted = false;
  bool vertical = false;
  double precision_m = 1e-4;
  glm::dvec3 com_in_world{0.0};
  /// Nothing given: where the reference has it.
  bool from_reference = true;
  double root_weight = 1.0;  ///< Vertical, and along the floor without balance.
  double root_weight_on_floor = 1.0;
};

/// A reference posture in single precision, in the body's unit, its root at the origin.
struct PostureNumbers {
  glm::dvec3 origin_in_world{0.0};
  std::vector<Quat<float>> parent_from_joint;
  std::vector<Quat<float>> rotation;  ///< World from joint.
  std::vector<Vec3<float>> place;
  std::vector<float> carried_mass;
  std::vector<Vec3<float>> carried_in_joint;
};

/// Forward kinematics of a posture, and what each live joint carries. `out` keeps its
/// memory. Precondition: finite, unit rotations.
void read_posture(const Plan& plan,
                  const BodyNumbers& body,
                  const Pose& pose,
                  bool balance,
                  PostureNumbers& out);

/// What never changes of a body goes into lane `lane`.
template <class F>
void load_body(const Plan& plan, const BodyNumbers& body, int lane, Lanes<F>& s) {
  for (std::size_t j = 0; j < body.offset.size(); ++j) {
    set_lane(s.offset[j], lane, body.offset[j]);
    const int limit = plan.limit_of[j];
    if (limit < 0) continue;
    const auto i = static_cast<std::size_t>(limit);
    set_lane(s.limit_from_joint[j], lane, body.limit_from_joint[i]);
    set_lane(s.rest_from_joint[j], lane, body.rest_from_joint[i]);
    set_lane(s.limit_min[j], lane, body.limit_min[i]);
    set_lane(s.limit_max[j], lane, body.limit_max[i]);
  }
  for (std::size_t l = 0; l < body.hinge.size(); ++l) {
    set_lane(s.hinge[l], lane, body.hinge[l]);
  }
  lane_of(s.least_trunk_thigh_cos, lane) = body.least_trunk_thigh_cos;
  lane_of(s.straight_knee_cos, lane) = body.straight_knee_cos;
}

template <class F>
void load_posture(const Plan& plan,
                  const PostureNumbers& posture,
                  bool balance,
                  int lane,
                  Lanes<F>& s) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    set_lane(s.reference_rotation[i], lane, posture.rotation[i]);
    set_lane(s.reference_place[i], lane, posture.place[i]);
    set_lane(s.reference_local[i], lane, posture.parent_from_joint[i]);
    if (!balance) continue;
    lane_of(s.carried_mass[i], lane) = posture.carried_mass[i];
    set_lane(s.carried_in_joint[i], lane, posture.carried_in_joint[i]);
  }
}

/// `wishes` are as Plan::points.
template <class F>
void load_wishes(const Plan& plan,
                 const BodyNumbers& body,
                 const glm::dvec3& origin_in_world,
                 std::span<const WishNumbers> wishes,
                 int lane,
                 Lanes<F>& s) {
  const double per_unit = 1.0 / body.unit_m;
  const auto place = [&](const glm::dvec3& p_in_world) {
    return lanes<Scalar<F>>((p_in_world - origin_in_world) * per_unit);
  };
  const auto length = [&](double m) { return static_cast<Scalar<F>>(m * per_unit); };
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    const WishNumbers& wish = wishes[k];
    LanePoint<F>& p = s.points[k];
    set_lane(p.in_joint, lane, lanes<Scalar<F>>(wish.in_joint * per_unit));
    set_lane(p.goal.a, lane, place(wish.a_in_world));
    const bool other = plan.points[k].goal == GoalKind::kDistanceToOther;
    set_lane(p.goal.b, lane, other ? lanes<Scalar<F>>(wish.b * per_unit) : place(wish.b));
    set_lane(p.goal.rotation, lane, lanes<Scalar<F>>(wish.world_from_joint));
    lane_of(p.goal.distance, lane) = length(wish.distance_m);
    lane_of(p.active, lane) = static_cast<Scalar<F>>(wish.active ? 1 : 0);
    lane_of(p.weight, lane) = static_cast<Scalar<F>>(wish.weight);
    // Finer than single precision resolves is never reached.
    lane_of(p.per_precision, lane) =
        static_cast<Scalar<F>>(1.0 / std::max(wish.precision_m * per_unit, 2e-6));
    p.at_distance = p.at_distance || wish.distance_m > 0.0;
  }
}

template <class F>
void load_balance(const BodyNumbers& body,
                  const PostureNumbers& posture,
                  const BalanceNumbers& balance,
                  int lane,
                  Lanes<F>& s) {
  const auto flag = [](bool on) { return static_cast<Scalar<F>>(on ? 1 : 0); };
  lane_of(s.balance, lane) = flag(balance.wanted);
  lane_of(s.vertical, lane) = flag(balance.vertical);
  lane_of(s.balance_precision, lane) =
      static_cast<Scalar<F>>(std::max(balance.precision_m / body.unit_m, 2e-6));
  lane_of(s.root_weight, lane) = static_cast<Scalar<F>>(balance.root_weight);
  lane_of(s.root_weight_on_floor, lane) =
      static_cast<Scalar<F>>(balance.root_weight_on_floor);
  if (!balance.wanted) return;
  glm::dvec3 target = (balance.com_in_world - posture.origin_in_world) / body.unit_m;
  if (balance.from_reference) {
    glm::dvec3 moment(0.0);
    double mass = 0.0;
    for (std::size_t j = 0; j < posture.carried_mass.size(); ++j) {
      const Vec3<float> at =
          posture.place[j] + rotate(posture.rotation[j], posture.carried_in_joint[j]);
      mass += posture.carried_mass[j];
      moment +=
          static_cast<double>(posture.carried_mass[j]) * glm::dvec3(at.x, at.y, at.z);
    }
    target = moment / std::max(mass, 1e-9);
  }
  set_lane(s.com_target, lane, lanes<Scalar<F>>(target));
}

}  // namespace marey::retarget
