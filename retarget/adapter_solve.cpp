// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/assert.h"
#include "retarget/activation.h"
#include "retarget/adapter_state.h"
#include "retarget/smooth_step.h"

namespace marey::retarget {
namespace {

// Unit to double precision: one Newton step from single precision's, without a root.
glm::dquat unit(double w, double x, double y, double z) {
  const double s = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
  return {s * w, s * x, s * y, s * z};
}

/// Reads what store_result() wrote.
class ResultReader {
 public:
  explicit ResultReader(const float* from) : from_(from) {}
  double number() { return static_cast<double>(*from_++); }
  glm::dvec3 vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  glm::dquat rotation() {
    const double w = number();
    const double x = number();
    const double y = number();
    return unit(w, x, y, number());
  }

 private:
  const float* from_;
};

// Constraints are closed on a mean of postures from this activation on, wholly at 1.
constexpr double kFirm = 0.8;

glm::dvec3 plain(const Vec3<float>& v) {
  return {v.x, v.y, v.z};
}

glm::dquat plain(const Quat<float>& q) {
  return unit(q.w, q.x, q.y, q.z);
}

}  // namespace

Adapter::State::State(const Character& character_in,
                      const ConstraintSet& constraints_in,
                      const AdaptOptions& options_in)
    : character(character_in),
      constraints(constraints_in),
      options(options_in),
      carried(character.loads.size(), 0),
      lanes(Plan{}) {
  for (const Constraint& c : constraints.constraints) live.emplace_back(c.activation);
  set_up();
}

void Adapter::State::set_up() {
  MAREY_ASSERT(!is_member);
  control = options.control;
  plan = make_plan(character, constraints, options.balance != BalanceMode::kOff);
  body = body_numbers(character, plan);
  for (std::size_t i = 0; i < carried.size(); ++i) {
    if (!carried[i]) set_mass(body, character.masses.size() + i, 0.0);
  }
  t_pose_from_joint = t_pose_rotations(character);
  lanes = Lanes<float>(plan);
  thesis = {make_thesis_plan(plan), options.balance != BalanceMode::kOff};
  solve = {};
  mixed_rotation.assign(plan.parent.size(), identity<float>());
  packed_posture.assign(4 * plan.parent.size(), 0.0F);
  packed_wishes.assign(kNumbersPerWish * plan.points.size(), 0.0F);
  wishes.assign(plan.points.size(), {});
  activations.assign(plan.points.size(), 0.0);
  ramps.clear();
  ramps.reserve(plan.points.size() + 1);
  outcomes.assign(constraints.constraints.size(), {});
  begun_in_world.resize(constraints.constraints.size());
  begun_rotation.resize(constraints.constraints.size());
  world_from_joint.resize(plan.parent.size());
  result.assign(result_size(plan), 0.0F);
}

Shape Adapter::State::shape() const {
  Shape out;
  out.rows.balance = options.balance != BalanceMode::kOff;
  for (const PointPlan& point : plan.points) {
    if (point.goal == GoalKind::kSupport) ++out.rows.supports;
  }
  // A blend asks all at once, by their weights.
  out.by_level = control == Control::kPriority;
  out.last_level = std::max(1, plan.level_count);
  return out;
}

SolveSettings Adapter::State::settings() const {
  SolveSettings out;
  out.blend = control == Control::kBlend;
  out.keeps_orientation = options.extremities_keep_orientation;
  out.max_iterations = options.max_iterations;
  return out;
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

void Adapter::State::read_wish(std::size_t k, double activation) {
  const PointPlan& point = plan.points[k];
  const auto c = static_cast<std::size_t>(point.constraint);
  const Constraint& constraint = constraints.constraints[c];
  const auto j = static_cast<std::size_t>(point.joint);
  const glm::dquat& t_pose = t_pose_from_joint[j];
  WishNumbers& wish = wishes[k];
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
    if (!wish.active) {
      begun_in_world[c].reset();
      begun_rotation[c].reset();
    } else if (!begun_in_world[c]) {
      stand();
      const Vec3<float> at =
          lanes.reference_place[j] +
          rotate(lanes.reference_rotation[j],
                 marey::retarget::lanes<float>(wish.in_joint / body.unit_m));
      begun_in_world[c] = origin_in_world + plain(at) * body.unit_m;
      begun_rotation[c] = plain(lanes.reference_rotation[j]);
    }
    wish.a_in_world =
        support.footprint_in_world.value_or(begun_in_world[c].value_or(origin_in_world));
    if (support.world_from_t_pose) {
      wish.world_from_joint = *support.world_from_t_pose * t_pose;
    } else if (support.footprint_in_world && !support.turns) {
      // Placed by somebody, turned as the reference has it at this moment.
      stand();
      wish.world_from_joint = plain(lanes.reference_rotation[j]);
    } else {
      wish.world_from_joint = begun_rotation[c].value_or(glm::dquat(1, 0, 0, 0));
    }
  }
}

void Adapter::State::read_wishes(double time_s) {
  double most = 0.0;
  ramps.clear();
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const auto c = static_cast<std::size_t>(plan.points[k].constraint);
    activations[k] = live[c].at(time_s);
    outcomes[c].activation = activations[k];
    read_wish(k, activations[k]);
    if (activations[k] > 0.0 && plan.points[k].level > 0) {
      most = std::max(most, wishes[k].weight);
    }
    const bool fades = activations[k] > 0.0 && activations[k] < 1.0;
    if (fades && std::find(ramps.begin(), ramps.end(), activations[k]) == ramps.end()) {
      ramps.push_back(activations[k]);
    }
  }
  std::sort(ramps.begin(), ramps.end(), [](double a, double b) { return a > b; });
  largest_weight = most;
}

// The reference into the adapter's own lane, once a posture.
void Adapter::State::stand() {
  if (is_standing) return;
  is_standing = true;
  load_body(plan, body.packed.data(), 0, lanes);
  load_posture(plan, packed_posture.data(), 0, lanes);
  load_balance(packed_balance.data(), 0, lanes);
  stand_reference(plan, options.balance != BalanceMode::kOff, true, lanes);
}

void Adapter::State::ask_for(double least) {
  // The thesis weights errors by importance in both modes (equation 4.2).
  const bool blends = control == Control::kBlend || options.method == Method::kThesis;
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    const auto c = static_cast<std::size_t>(plan.points[k].constraint);
    const bool weighs = blends && plan.points[k].level > 0 && largest_weight > 0.0;
    wishes[k].weight =
        weighs ? constraints.constraints[c].importance / largest_weight : 1.0;
    wishes[k].active = activations[k] >= least && activations[k] > 0.0;
  }
  pack_wishes(plan, body, origin_in_world, wishes, packed_wishes);
}

Errors<float> Adapter::State::solve_for(double least, double& iterations) {
  ask_for(least);
  load_wishes(plan, packed_wishes.data(), 0, lanes);
  const Shape form = shape();
  const SolveSettings told = settings();
  if (options.method == Method::kThesis) {
    begin_thesis(plan, thesis, told, true, lanes, solve);
    while (!advance_thesis(plan, thesis, told, lanes, solve)) {
    }
    iterations += static_cast<double>(solve.progress.iterations);
    return finish_thesis(plan, thesis, told, true, lanes);
  }
  begin_lanes(plan, form, told, true, lanes, solve);
  if (solve.needs_body > 0.0F) {
    while (!advance_lanes(plan, form, told, lanes, solve)) {
    }
  }
  iterations += static_cast<double>(solve.progress.iterations);
  return finish_lanes(plan, form, told, true, lanes, solve);
}

void Adapter::State::mix(float share) {
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    const Quat<float>& q = lanes.rotation[i];
    Quat<float>& sum = mixed_rotation[i];
    const Quat<float>& like = lanes.reference_rotation[i];
    const float sign =
        q.w * like.w + q.x * like.x + q.y * like.y + q.z * like.z < 0.0F ? -share : share;
    sum = {
        sum.w + sign * q.w, sum.x + sign * q.x, sum.y + sign * q.y, sum.z + sign * q.z};
  }
  mixed_root += share * lanes.place[0];
}

// Where the passage from one control to the other is.
void Adapter::State::pass_over(double time_s) {
  control = options.control;
  left_share = 0.0;
  if (!left_control) return;
  if (!left_since_s) left_since_s = time_s;
  const double gone = time_s - *left_since_s;
  left_share = options.control_change_s > 0.0
                   ? 1.0 - smooth_step(gone / options.control_change_s)
                   : 0.0;
  if (left_share <= 0.0) left_control.reset();
}

// Constraints fade between the postures without and with them. With activations
// 1 = a0 > a1 > ... > an > an+1 = 0 and posture Si for all constraints of at least ai,
// the answer is the mean of the Si with weights ai - ai+1: continuous in every
// activation, also as they pass each other, and exact where nothing fades (the Lovasz
// extension of the map from sets of constraints to postures). What is fully active is
// then closed again from that mean.
Errors<float> Adapter::State::solve_faded(double& iterations) {
  for (Quat<float>& q : mixed_rotation) q = {0.0F, 0.0F, 0.0F, 0.0F};
  mixed_root = {0.0F, 0.0F, 0.0F};
  const auto add_all = [&](Control asked, double weight) {
    control = asked;
    double above = 1.0;
    for (std::size_t n = 0; n <= ramps.size(); ++n) {
      const double next = n < ramps.size() ? ramps[n] : 0.0;
      static_cast<void>(solve_for(n == 0 ? 1.0 : ramps[n - 1], iterations));
      mix(static_cast<float>(weight * (above - next)));
      above = next;
    }
  };
  if (left_share > 0.0) add_all(*left_control, left_share);
  add_all(options.control, 1.0 - left_share);
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    wishes[k].active = activations[k] > kFirm;
  }
  pack_wishes(plan, body, origin_in_world, wishes, packed_wishes);
  load_wishes(plan, packed_wishes.data(), 0, lanes);
  for (const int j : plan.live) {
    const auto i = static_cast<std::size_t>(j);
    lanes.rotation[i] = normalized(mixed_rotation[i]);
    // Between two postures that keep a limit may be one that does not.
    if (j > 0) {
      const auto p = static_cast<std::size_t>(plan.parent[i]);
      lanes.rotation[i] = limited(plan, lanes, j, lanes.rotation[p], lanes.rotation[i]);
    }
  }
  lanes.place[0] = mixed_root;
  place_live_joints(plan, lanes);
  const auto last = static_cast<float>(shape().last_level);
  static_cast<void>(measure(plan, shape().rows.balance, last, lanes));
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    LanePoint<float>& p = lanes.points[k];
    const auto share =
        static_cast<float>(smooth_step((activations[k] - kFirm) / (1.0 - kFirm)));
    p.target = p.place + share * (p.target - p.place);
  }
  close_limbs(plan, settings(), last, true, lanes);
  return measure(plan, shape().rows.balance, last, lanes);
}

void Adapter::State::write(const float* numbers, Pose& out) {
  const std::size_t n = plan.parent.size();
  out.parent_from_joint.resize(n);
  ResultReader from(numbers);
  for (std::size_t i = 0; i < n; ++i) out.parent_from_joint[i] = from.rotation();
  for (std::size_t i = 0; i < n; ++i) world_from_joint[i].rotation = from.rotation();
  for (std::size_t i = 0; i < n; ++i) {
    world_from_joint[i].translation = origin_in_world + from.vector() * body.unit_m;
  }
  for (ConstraintOutcome& outcome : outcomes) outcome.error_m = 0.0;
  for (const PointPlan& point : plan.points) {
    outcomes[static_cast<std::size_t>(point.constraint)].error_m =
        from.number() * body.unit_m;
  }
  com_now_in_world = origin_in_world + from.vector() * body.unit_m;
  report.iterations = static_cast<int>(from.number());
  report.constraint_error_m = from.number() * body.unit_m;
  report.worst_error_m = from.number() * body.unit_m;
  report.balance_error_m = from.number() * body.unit_m;
  out.root_in_world = world_from_joint[0].translation;
}

bool Adapter::State::prepare(const Pose& reference, double time_s) {
  origin_in_world = reference.root_in_world;
  pack_posture(reference, packed_posture);
  pack_balance(body, origin_in_world, balance(), packed_balance);
  is_standing = false;
  read_wishes(time_s);
  pass_over(time_s);
  if (!ramps.empty() || left_share > 0.0) return false;
  ask_for(1.0);
  return true;
}

AdaptReport Adapter::State::adapt(const Pose& reference, double time_s, Pose& out) {
  const bool fades = !prepare(reference, time_s);
  return solve_prepared(fades, out);
}

AdaptReport Adapter::State::solve_prepared(bool fades, Pose& out) {
  stand();
  double iterations = 0.0;
  const Errors<float> errors =
      fades ? solve_faded(iterations) : solve_for(1.0, iterations);
  spread_posture(plan, lanes);
  store_result(plan, errors, static_cast<float>(iterations), 0, lanes, result.data());
  write(result.data(), out);
  return report;
}

}  // namespace marey::retarget
