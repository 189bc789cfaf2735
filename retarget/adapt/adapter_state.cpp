// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/adapter_state.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::retarget {
namespace {

/// Reads the result of store_result().
class ResultReader {
 public:
  explicit ResultReader(const float* from) : from_(from) {}
  [[nodiscard]] const float* here() const { return from_; }
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
    return unit_rotation(w, x, y, number());
  }

 private:
  const float* from_;
};

static_assert(kHomingSteps == kFirstSteps && kHomingStepsBalanced == kFirstStepsBalanced);

}  // namespace

AdapterState::AdapterState(const Character& character_in,
                           const ConstraintSet& constraints_in,
                           const AdaptOptions& options_in)
    : character(character_in),
      constraints(constraints_in),
      options(options_in),
      carried(character.loads.size(), 0),
      own_problem(plan),
      lanes(Plan{}) {
  for (const Constraint& c : constraints.constraints) live.emplace_back(c.activation);
  set_up();
}

void AdapterState::set_up() {
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
  mixed_beyond.assign(plan.parent.size(), 0.0F);
  mixed_left.assign(plan.points.size(), {});
  firmness.assign(plan.points.size(), 0.0F);
  own_problem = PackedProblem(plan);
  outcomes.assign(constraints.constraints.size(), {});
  begun_in_world.resize(constraints.constraints.size());
  begun_rotation.resize(constraints.constraints.size());
  world_from_joint.resize(plan.parent.size());
  result.assign(result_size(plan), 0.0F);
}

Shape AdapterState::shape() const {
  Shape out;
  out.rows.balance = options.balance != BalanceMode::kOff;
  for (const PointPlan& point : plan.points) {
    if (point.goal == GoalKind::kSupport) ++out.rows.supports;
  }
  // A blend solves all levels together, by their weights.
  out.by_level = control == Control::kPriority;
  out.last_level = std::max(1, plan.level_count);
  return out;
}

SolveSettings AdapterState::settings() const {
  SolveSettings out;
  out.blend = control == Control::kBlend;
  out.keeps_orientation = options.extremities_keep_orientation;
  out.max_iterations = options.max_iterations;
  return out;
}

void AdapterState::solve_for(double min_activation, LaneFigures<float>& figures) {
  pack_problem(min_activation, own_problem);
  load_targets(plan, own_problem.targets.data(), 0, lanes);
  const Shape form = shape();
  const SolveSettings solve_settings = settings();
  const auto add = [&](const Errors<float>& errors) {
    figures.iterations += solve.progress.iterations;
    figures.capped = std::max(figures.capped, solve.progress.capped);
    figures.balance = errors.balance;
  };
  if (options.method == Method::kThesis) {
    begin_thesis(plan, thesis, solve_settings, true, lanes, solve);
    while (!advance_thesis(plan, thesis, solve_settings, lanes, solve)) {
    }
    add(finish_thesis(plan, thesis, solve_settings, true, lanes, solve));
    return;
  }
  begin_lanes(plan, form, solve_settings, true, lanes, solve);
  if (solve.needs_body > 0.0F) {
    while (!advance_lanes(plan, form, solve_settings, lanes, solve)) {
    }
  }
  add(finish_lanes(plan, form, solve_settings, true, lanes, solve));
}

void AdapterState::update_report(const Plan& shared, const float* errors) {
  report = {};
  double weights = 0.0;
  for (std::size_t k = 0; k < shared.points.size(); ++k) {
    const PointPlan& point = shared.points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const Constraint& constraint = constraints.constraints[c];
    ConstraintOutcome& outcome = outcomes[c];
    const auto error = static_cast<double>(errors[k]);
    const bool counts = outcome.activation > kFirmActivation;
    outcome.error_m = 0.0;
    outcome.error_rad = 0.0;
    if (point.turns_only()) {
      // turn_left() returns twice the sine of half the angle.
      outcome.error_rad = 2.0 * std::asin(std::min(1.0, 0.5 * error));
    } else {
      outcome.error_m = error * body.unit_m;
    }
    outcome.met = counts && is_met(constraint, {outcome.error_m, outcome.error_rad});
    report.worst_error_m = std::max(report.worst_error_m, outcome.error_m);
    report.worst_error_rad = std::max(report.worst_error_rad, outcome.error_rad);
    if (!counts || point.turns_only() || point.level == 0) continue;
    report.constraint_error_m += constraint.importance * outcome.error_m;
    weights += constraint.importance;
  }
  if (weights > 0.0) report.constraint_error_m /= weights;
}

void AdapterState::write(const Plan& shared, const float* numbers, Pose& out) {
  const std::size_t n = shared.parent.size();
  out.parent_from_joint.resize(n);
  ResultReader from(numbers);
  for (std::size_t i = 0; i < n; ++i) out.parent_from_joint[i] = from.rotation();
  for (std::size_t i = 0; i < n; ++i) world_from_joint[i].rotation = from.rotation();
  for (std::size_t i = 0; i < n; ++i) {
    world_from_joint[i].translation = origin_in_world + from.vector() * body.unit_m;
  }
  update_report(shared, from.here());
  for (std::size_t k = 0; k < shared.points.size(); ++k) from.number();
  report.iterations = static_cast<int>(from.number());
  report.capped = from.number() > 0.0;
  report.balance_error_m = from.number() * body.unit_m;
  out.root_in_world = world_from_joint[0].translation;
}

AdaptReport AdapterState::adapt(const Pose& reference, double time_s, Pose& out) {
  const bool fades = !prepare(reference, time_s, own_problem);
  stand(own_problem);
  LaneFigures<float> figures;
  if (fades) {
    solve_faded(figures);
  } else {
    solve_for(1.0, figures);
  }
  spread_posture(plan, lanes);
  store_result(plan, figures, 0, lanes, result.data());
  write(plan, result.data(), out);
  return report;
}

}  // namespace marey::retarget
