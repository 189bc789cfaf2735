// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "retarget/activation.h"
#include "retarget/adapter_state.h"
#include "retarget/smooth_step.h"

namespace marey::retarget {
namespace {

glm::dvec3 plain(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

glm::dquat plain(const Quat<float>& q) {
  return unit_rotation(q.w, q.x, q.y, q.z);
}

// Of joint `j` in the world, to the bit as stand_reference() has it.
Quat<float> reference_rotation(const Plan& plan, const PackedQuestion& asked, int j) {
  const auto i = static_cast<std::size_t>(j);
  const float* q = &asked.posture[4 * i];
  const Quat<float> own{q[0], q[1], q[2], q[3]};
  return plan.parent[i] < 0 ? own : reference_rotation(plan, asked, plan.parent[i]) * own;
}

/// Has the processor bring memory near, if it can be asked to.
void call_for(const void* memory, std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  const auto* at = static_cast<const char*>(memory);
  for (std::size_t n = 0; n < bytes; n += kLine) {
#if defined(__GNUC__)
    __builtin_prefetch(at + n);
#endif
  }
}

template <class T>
void call_for(const std::vector<T>& numbers) {
  call_for(numbers.data(), numbers.size() * sizeof(T));
}

}  // namespace

PackedQuestion::PackedQuestion(const Plan& shared)
    : plan(&shared),
      posture(4 * shared.parent.size()),
      wishes(kNumbersPerWish * shared.points.size()),
      numbers(shared.points.size()),
      activations(shared.points.size()) {
  ramps.reserve(shared.points.size() + 1);
}

BalanceNumbers Adapter::State::balance() const {
  BalanceNumbers out;
  out.wanted = options.balance != BalanceMode::kOff;
  out.vertical = options.balance == BalanceMode::k3d;
  out.precision_m = options.balance_precision_m;
  out.constraint_threshold_m = options.constraint_threshold_m;
  out.balance_threshold_m = options.balance_threshold_m;
  out.from_reference = !com_in_world;
  out.com_in_world = com_in_world.value_or(glm::dvec3(0.0));
  // The root belongs to balance along the axes that it uses (thesis 5.3.2).
  out.root_weight =
      out.vertical ? options.root_for_balance : options.root_for_constraints;
  out.root_weight_on_floor =
      out.wanted ? options.root_for_balance : options.root_for_constraints;
  return out;
}

void Adapter::State::read_wish(std::size_t k, double activation, PackedQuestion& asked) {
  const Plan& shared = *asked.plan;
  const PointPlan& point = shared.points[k];
  const auto c = static_cast<std::size_t>(point.constraint);
  const Constraint& constraint = constraints.constraints[c];
  const auto j = static_cast<std::size_t>(point.joint);
  const glm::dquat& t_pose = t_pose_from_joint[j];
  WishNumbers& wish = asked.numbers[k];
  wish.in_joint = glm::conjugate(t_pose) * constraint.point.offset_in_t_pose;
  wish.precision_m = constraint.precision_m;
  wish.weight = constraint.importance;
  wish.active = activation > 0.0;
  const Goal& goal = constraint.goal;
  const auto other = [&](const BodyPoint& body_point) {
    const auto o = static_cast<std::size_t>(point.other_joint);
    return glm::conjugate(t_pose_from_joint[o]) * body_point.offset_in_t_pose;
  };
  if (const auto* to_point = std::get_if<DistanceToPoint>(&goal)) {
    wish.a_in_world = to_point->p_in_world;
    wish.distance_m = to_point->distance_m;
  } else if (const auto* to_body = std::get_if<DistanceToBody>(&goal)) {
    wish.b = other(to_body->other);
    wish.distance_m = to_body->distance_m;
  } else if (const auto* to_other = std::get_if<DistanceToConstraint>(&goal)) {
    wish.b = other(constraints.find(to_other->other_id)->point);
    wish.distance_m = to_other->distance_m;
  } else if (const auto* allowed = std::get_if<AllowedSpace>(&goal)) {
    wish.a_in_world = allowed->min_in_world;
    wish.b = allowed->max_in_world;
  } else if (const auto* forbidden = std::get_if<ForbiddenSpace>(&goal)) {
    wish.a_in_world = forbidden->min_in_world;
    wish.b = forbidden->max_in_world;
  } else if (const auto* orientation = std::get_if<SegmentOrientation>(&goal)) {
    wish.world_from_joint = orientation->world_from_t_pose * t_pose;
  } else {
    const auto& support = std::get<Support>(goal);
    follow_support(c, point.joint, asked, wish);
    wish.a_in_world =
        support.footprint_in_world.value_or(begun_in_world[c].value_or(origin_in_world));
    if (support.world_from_t_pose) {
      wish.world_from_joint = *support.world_from_t_pose * t_pose;
    } else if (support.footprint_in_world && !support.turns) {
      // Placed by somebody, turned as the reference has it at this moment.
      wish.world_from_joint = plain(reference_rotation(shared, asked, point.joint));
    } else {
      wish.world_from_joint = begun_rotation[c].value_or(glm::dquat(1, 0, 0, 0));
    }
  }
}

void Adapter::State::follow_support(std::size_t constraint,
                                    int joint,
                                    const PackedQuestion& asked,
                                    const WishNumbers& wish) {
  std::optional<glm::dvec3>& place = begun_in_world[constraint];
  std::optional<glm::dquat>& rotation = begun_rotation[constraint];
  if (!wish.active) {
    place.reset();
    rotation.reset();
    return;
  }
  if (place) return;
  stand(asked);
  const auto j = static_cast<std::size_t>(joint);
  const Vec3<float> at =
      lanes.reference_place[j] +
      rotate(lanes.reference_rotation[j],
             marey::retarget::lanes<float>(wish.in_joint / body.unit_m));
  place = origin_in_world + plain(at) * body.unit_m;
  rotation = plain(lanes.reference_rotation[j]);
}

void Adapter::State::read_wishes(double time_s, PackedQuestion& asked) {
  const Plan& shared = *asked.plan;
  std::vector<double>& activations = asked.activations;
  std::vector<double>& ramps = asked.ramps;
  std::vector<WishNumbers>& wishes = asked.numbers;
  double most = 0.0;
  ramps.clear();
  for (std::size_t k = 0; k < shared.points.size(); ++k) {
    const auto c = static_cast<std::size_t>(shared.points[k].constraint);
    activations[k] = live[c].at(time_s);
    outcomes[c].activation = activations[k];
    read_wish(k, activations[k], asked);
    if (activations[k] > 0.0 && shared.points[k].level > 0) {
      most = std::max(most, wishes[k].weight);
    }
    const bool fades = activations[k] > 0.0 && activations[k] < 1.0;
    if (fades && std::find(ramps.begin(), ramps.end(), activations[k]) == ramps.end()) {
      ramps.push_back(activations[k]);
    }
  }
  std::sort(ramps.begin(), ramps.end(), [](double a, double b) { return a > b; });
  asked.largest_weight = most;
}

// The reference into the adapter's own lane, once a posture.
void Adapter::State::stand(const PackedQuestion& asked) {
  if (is_standing) return;
  is_standing = true;
  load_body(plan, body.packed.data(), 0, lanes);
  load_posture(plan, asked.posture.data(), 0, lanes);
  load_balance(asked.balance.data(), 0, lanes);
  stand_reference(plan, options.balance != BalanceMode::kOff, true, lanes);
}

void Adapter::State::ask_for(double least, PackedQuestion& asked) const {
  // The thesis weights errors by importance in both modes (equation 4.2).
  const bool blends = control == Control::kBlend || options.method == Method::kThesis;
  for (std::size_t k = 0; k < asked.numbers.size(); ++k) {
    const PointPlan& point = asked.plan->points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const bool weighs = blends && point.level > 0 && asked.largest_weight > 0.0;
    asked.numbers[k].weight =
        weighs ? constraints.constraints[c].importance / asked.largest_weight : 1.0;
    const double activation = asked.activations[k];
    asked.numbers[k].active = activation >= least && activation > 0.0;
  }
  pack_wishes(*asked.plan, body, origin_in_world, asked.numbers, asked.wishes);
}

// Where the passage from one control to the other is.
void Adapter::State::pass_over(double time_s) {
  control = options.control;
  left_share = 0.0;
  const double duration_s = options.control_change_s;
  if (duration_s <= 0.0) passed = 1.0;
  if (passed >= 1.0) return;
  if (!passes_since_s) passes_since_s = time_s - passed * duration_s;
  passed = std::clamp((time_s - *passes_since_s) / duration_s, 0.0, 1.0);
  left_share = 1.0 - smooth_step(passed);
}

void Adapter::State::turn_passage(const AdaptOptions& to) {
  if (to.control != options.control) {
    left_control = options.control;
    // The ramp is its own mirror image: the share stays what it was.
    passed = 1.0 - passed;
  } else if (to.control_change_s == options.control_change_s) {
    return;
  }
  passes_since_s.reset();
}

void Adapter::State::call_for_state() const {
  const auto* begin = reinterpret_cast<const char*>(&constraints);
  call_for(begin, static_cast<std::size_t>(reinterpret_cast<const char*>(&plan) - begin));
}

void Adapter::State::call_for_numbers() const {
  for (const Constraint& c : constraints.constraints) {
    const auto* begin = reinterpret_cast<const char*>(&c.point.offset_in_t_pose);
    const auto* end = reinterpret_cast<const char*>(&c.activation);
    call_for(begin, static_cast<std::size_t>(end - begin));
  }
  call_for(body.packed);
  for (const LiveActivation& activation : live) call_for(&activation, 64);
  call_for(outcomes);
  call_for(world_from_joint);
}

void Adapter::State::call_for_pose(const Pose& pose) {
  call_for(pose.parent_from_joint);
}

bool Adapter::State::prepare(const Pose& reference,
                             double time_s,
                             PackedQuestion& asked) {
  origin_in_world = reference.root_in_world;
  pack_posture(reference, asked.posture);
  pack_balance(body, origin_in_world, balance(), asked.balance);
  is_standing = false;
  read_wishes(time_s, asked);
  pass_over(time_s);
  if (!asked.ramps.empty() || left_share > 0.0) return false;
  ask_for(1.0, asked);
  return true;
}

}  // namespace marey::retarget
