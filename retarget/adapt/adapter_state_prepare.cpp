// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "retarget/adapt/adapter_state.h"
#include "core/base/smooth_step.h"
#include "retarget/constraints/activation.h"

namespace marey::retarget {
namespace {

glm::dvec3 plain(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

glm::dquat plain(const Quat<float>& q) {
  return unit_rotation(q.w, q.x, q.y, q.z);
}

// Returns the world rotation of joint `j`, equal to the bit to that of stand_reference().
Quat<float> reference_rotation(const Plan& plan, const PackedProblem& problem, int j) {
  const auto i = static_cast<std::size_t>(j);
  const float* q = &problem.posture[4 * i];
  const Quat<float> own{q[0], q[1], q[2], q[3]};
  return plan.parent[i] < 0 ? own
                            : reference_rotation(plan, problem, plan.parent[i]) * own;
}

/// Prefetches memory into the cache where the compiler supports it.
void prefetch(const void* memory, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  const auto* at = static_cast<const char*>(memory);
  for (std::size_t n = 0; n < bytes; n += kLine) {
#if defined(__GNUC__)
    __builtin_prefetch(at + n);
#endif
  }
}

template <class T>
void prefetch(const std::vector<T>& numbers) {
  prefetch(numbers.data(), numbers.size() * sizeof(T));
}

}  // namespace

PackedProblem::PackedProblem(const Plan& shared)
    : plan(&shared),
      posture(4 * shared.parent.size()),
      targets(kNumbersPerTarget * shared.points.size()),
      numbers(shared.points.size()),
      activations(shared.points.size()) {
  ramps.reserve(shared.points.size() + 1);
}

BalanceNumbers AdapterState::balance() const {
  BalanceNumbers out;
  out.wanted = options.balance != BalanceMode::kOff;
  out.vertical = options.balance == BalanceMode::k3d;
  out.precision_m = options.balance_precision_m;
  out.constraint_threshold_m = options.constraint_threshold_m;
  out.balance_threshold_m = options.balance_threshold_m;
  out.from_reference = !com_in_world;
  out.com_in_world = com_in_world.value_or(glm::dvec3(0.0));
  // Balance uses the root completely along its axes (thesis 5.3.2).
  out.root_weight =
      out.vertical ? options.root_for_balance : options.root_for_constraints;
  out.root_weight_on_floor =
      out.wanted ? options.root_for_balance : options.root_for_constraints;
  return out;
}

void AdapterState::read_target(std::size_t k, double activation, PackedProblem& problem) {
  const Plan& shared = *problem.plan;
  const PointPlan& point = shared.points[k];
  const auto c = static_cast<std::size_t>(point.constraint);
  const Constraint& constraint = constraints.constraints[c];
  const auto j = static_cast<std::size_t>(point.joint);
  const glm::dquat& t_pose = t_pose_from_joint[j];
  TargetNumbers& target = problem.numbers[k];
  target.in_joint = glm::conjugate(t_pose) * constraint.point.offset_in_t_pose;
  target.precision_m = constraint.precision_m;
  target.weight = constraint.importance;
  target.active = activation > 0.0;
  const Goal& goal = constraint.goal;
  const auto other = [&](const BodyPoint& body_point) {
    const auto o = static_cast<std::size_t>(point.other_joint);
    return glm::conjugate(t_pose_from_joint[o]) * body_point.offset_in_t_pose;
  };
  if (const auto* to_point = std::get_if<DistanceToPoint>(&goal)) {
    target.a_in_world = to_point->p_in_world;
    target.distance_m = to_point->distance_m;
  } else if (const auto* to_body = std::get_if<DistanceToBody>(&goal)) {
    target.b = other(to_body->other);
    target.distance_m = to_body->distance_m;
  } else if (const auto* to_other = std::get_if<DistanceToConstraint>(&goal)) {
    target.b = other(constraints.find(to_other->other_id)->point);
    target.distance_m = to_other->distance_m;
  } else if (const auto* allowed = std::get_if<AllowedSpace>(&goal)) {
    target.a_in_world = allowed->min_in_world;
    target.b = allowed->max_in_world;
  } else if (const auto* forbidden = std::get_if<ForbiddenSpace>(&goal)) {
    target.a_in_world = forbidden->min_in_world;
    target.b = forbidden->max_in_world;
  } else if (const auto* orientation = std::get_if<SegmentOrientation>(&goal)) {
    target.world_from_joint = orientation->world_from_t_pose * t_pose;
  } else {
    const auto& support = std::get<Support>(goal);
    follow_support(c, point.joint, problem, target);
    target.a_in_world =
        support.footprint_in_world.value_or(begun_in_world[c].value_or(origin_in_world));
    if (support.world_from_t_pose) {
      target.world_from_joint = *support.world_from_t_pose * t_pose;
    } else if (support.footprint_in_world && !support.turns) {
      // The position is given, the rotation is that of the current reference.
      target.world_from_joint = plain(reference_rotation(shared, problem, point.joint));
    } else {
      target.world_from_joint = begun_rotation[c].value_or(glm::dquat(1, 0, 0, 0));
    }
  }
}

void AdapterState::follow_support(std::size_t constraint,
                                  int joint,
                                  const PackedProblem& problem,
                                  const TargetNumbers& target) {
  std::optional<glm::dvec3>& place = begun_in_world[constraint];
  std::optional<glm::dquat>& rotation = begun_rotation[constraint];
  if (!target.active) {
    place.reset();
    rotation.reset();
    return;
  }
  if (place) return;
  stand(problem);
  const auto j = static_cast<std::size_t>(joint);
  const Vec3<float> at =
      lanes.reference_place[j] +
      rotate(lanes.reference_rotation[j],
             marey::retarget::lanes<float>(target.in_joint / body.unit_m));
  place = origin_in_world + plain(at) * body.unit_m;
  rotation = plain(lanes.reference_rotation[j]);
}

void AdapterState::read_targets(double time_s, PackedProblem& problem) {
  const Plan& shared = *problem.plan;
  std::vector<double>& activations = problem.activations;
  std::vector<double>& ramps = problem.ramps;
  std::vector<TargetNumbers>& targets = problem.numbers;
  double max_weight = 0.0;
  ramps.clear();
  for (std::size_t k = 0; k < shared.points.size(); ++k) {
    const auto c = static_cast<std::size_t>(shared.points[k].constraint);
    activations[k] = live[c].at(time_s);
    outcomes[c].activation = activations[k];
    read_target(k, activations[k], problem);
    if (activations[k] > 0.0 && shared.points[k].level > 0) {
      max_weight = std::max(max_weight, targets[k].weight);
    }
    const bool fades = activations[k] > 0.0 && activations[k] < 1.0;
    if (fades && std::find(ramps.begin(), ramps.end(), activations[k]) == ramps.end()) {
      ramps.push_back(activations[k]);
    }
  }
  std::sort(ramps.begin(), ramps.end(), [](double a, double b) { return a > b; });
  problem.max_weight = max_weight;
}

// Loads the reference into the adapter's own lane, once per posture.
void AdapterState::stand(const PackedProblem& problem) {
  if (is_standing) return;
  is_standing = true;
  load_body(plan, body.packed.data(), 0, lanes);
  load_posture(plan, problem.posture.data(), 0, lanes);
  load_balance(problem.balance.data(), 0, lanes);
  stand_reference(plan, options.balance != BalanceMode::kOff, true, lanes);
}

void AdapterState::pack_problem(double min_activation, PackedProblem& problem) const {
  // The thesis weights errors by importance in both modes (equation 4.2).
  const bool blends = control == Control::kBlend || options.method == Method::kThesis;
  for (std::size_t k = 0; k < problem.numbers.size(); ++k) {
    const PointPlan& point = problem.plan->points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const bool weighs = blends && point.level > 0 && problem.max_weight > 0.0;
    problem.numbers[k].weight =
        weighs ? constraints.constraints[c].importance / problem.max_weight : 1.0;
    const double activation = problem.activations[k];
    problem.numbers[k].active = activation >= min_activation && activation > 0.0;
  }
  pack_targets(*problem.plan, body, origin_in_world, problem.numbers, problem.targets);
}

// Updates the progress of the fade from one control to the other.
void AdapterState::pass_over(double time_s) {
  control = options.control;
  left_share = 0.0;
  const double duration_s = options.control_change_s;
  if (duration_s <= 0.0) passed = 1.0;
  if (passed >= 1.0) return;
  if (!passes_since_s) passes_since_s = time_s - passed * duration_s;
  passed = std::clamp((time_s - *passes_since_s) / duration_s, 0.0, 1.0);
  left_share = 1.0 - smooth_step(passed);
}

void AdapterState::turn_passage(const AdaptOptions& to) {
  if (to.control != options.control) {
    left_control = options.control;
    // The ramp is symmetric, so the share is unchanged.
    passed = 1.0 - passed;
  } else if (to.control_change_s == options.control_change_s) {
    return;
  }
  passes_since_s.reset();
}

void AdapterState::prefetch_state() const {
  const auto* begin = reinterpret_cast<const char*>(&constraints);
  prefetch(begin, static_cast<std::size_t>(reinterpret_cast<const char*>(&plan) - begin));
}

void AdapterState::prefetch_numbers() const {
  for (const Constraint& c : constraints.constraints) {
    const auto* begin = reinterpret_cast<const char*>(&c.point.offset_in_t_pose);
    const auto* end = reinterpret_cast<const char*>(&c.activation);
    prefetch(begin, static_cast<std::size_t>(end - begin));
  }
  prefetch(body.packed);
  for (const LiveActivation& activation : live) prefetch(&activation, 64);
  prefetch(outcomes);
  prefetch(world_from_joint);
}

void AdapterState::prefetch_pose(const Pose& pose) {
  prefetch(pose.parent_from_joint);
}

bool AdapterState::prepare(const Pose& reference, double time_s, PackedProblem& problem) {
  origin_in_world = reference.root_in_world;
  pack_posture(reference, problem.posture);
  pack_balance(body, origin_in_world, balance(), problem.balance);
  is_standing = false;
  read_targets(time_s, problem);
  pass_over(time_s);
  if (!problem.ramps.empty() || left_share > 0.0) return false;
  pack_problem(1.0, problem);
  return true;
}

}  // namespace marey::retarget
