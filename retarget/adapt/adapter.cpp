// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/adapter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "retarget/adapt/adapter_state.h"
#include "retarget/character/check_character.h"
#include "retarget/constraints/check_constraints.h"

namespace marey::retarget {
namespace {

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_unit(const glm::dquat& q) {
  return std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-4;
}

Status check_options(const AdaptOptions& options) {
  const auto share = [](double x) { return x >= 0.0 && x <= 1.0; };
  const auto length = [](double x) { return x >= 0.0 && std::isfinite(x); };
  if (!share(options.root_for_constraints) || !share(options.root_for_balance)) {
    return bad_input("adaptation",
                     "the root's share of the travel is not from 0 to 1",
                     "use 0 to keep the root in place, up to 1 for its full travel");
  }
  if (!length(options.constraint_threshold_m) || !length(options.balance_threshold_m) ||
      !length(options.balance_precision_m) || !length(options.control_change_s)) {
    return bad_input("adaptation",
                     "a threshold or a duration is negative or not a number",
                     "give metres and seconds, 0 or more");
  }
  if (options.balance == BalanceMode::kZmp) {
    return bad_input(
        "adaptation",
        "balance by the zero moment point needs a whole motion, not single "
        "postures",
        "use horizontal balance, or adapt_motion() with a centre of mass per "
        "frame");
  }
  if (options.max_iterations < 1) {
    return bad_input(
        "adaptation", "max_iterations is below 1", "use at least 1; the default is 50");
  }
  return Done{};
}

}  // namespace

Result<Adapter> Adapter::make(const Character& character,
                              const ConstraintSet& constraints,
                              const AdaptOptions& options) {
  if (const Status s = check_options(options); !s) return s.error();
  if (const Status s = check_character(character); !s) return s.error();
  if (const Status s = check_constraints(constraints, character); !s) return s.error();
  return Adapter(std::make_unique<AdapterState>(character, constraints, options));
}

Adapter::Adapter(std::unique_ptr<AdapterState> state) : state_(std::move(state)) {}
Adapter::Adapter(Adapter&&) noexcept = default;
Adapter& Adapter::operator=(Adapter&&) noexcept = default;
Adapter::~Adapter() = default;

std::optional<Adapter::Handle> Adapter::constraint(std::string_view id) {
  const std::vector<Constraint>& all = state_->constraints.constraints;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].id == id) return Handle(*state_, i);
  }
  return std::nullopt;
}

void Adapter::set_balance_target(const std::optional<glm::dvec3>& com_in_world) {
  MAREY_ASSERT(!com_in_world || is_finite(*com_in_world));
  state_->com_in_world = com_in_world;
}

bool Adapter::carry(std::string_view load, bool carried) {
  const std::vector<Load>& loads = state_->character.loads;
  const std::size_t own = state_->character.masses.size();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i].name != load) continue;
    state_->carried[i] = carried ? 1 : 0;
    set_mass(state_->body, own + i, carried ? loads[i].mass.mass_kg : 0.0);
    return true;
  }
  return false;
}

void Adapter::set_options(const AdaptOptions& options) {
  MAREY_ASSERT(check_options(options).has_value());
  MAREY_ASSERT(!state_->is_member);
  const bool replan = (options.balance == BalanceMode::kOff) !=
                      (state_->options.balance == BalanceMode::kOff);
  state_->turn_passage(options);
  state_->options = options;
  state_->control = options.control;
  if (replan) state_->set_up();
}

AdaptReport Adapter::adapt(const Pose& reference, double time_s, Pose& out) {
  return state_->adapt(reference, time_s, out);
}

std::span<const RigidTransform> Adapter::world_from_joint() const {
  return state_->world_from_joint;
}

glm::dvec3 Adapter::centre_of_mass_in_world() const {
  const AdapterState& s = *state_;
  glm::dvec3 moment(0.0);
  double mass_kg = 0.0;
  const auto add = [&](const PointMass& mass) {
    moment += mass.mass_kg * (s.world_from_joint[index(mass.joint)] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  };
  for (const PointMass& mass : s.character.masses) add(mass);
  for (std::size_t i = 0; i < s.carried.size(); ++i) {
    if (s.carried[i]) add(s.character.loads[i].mass);
  }
  return moment / mass_kg;
}

void Adapter::Handle::set_target(const glm::dvec3& p_in_world) {
  MAREY_ASSERT(is_finite(p_in_world));
  Goal& goal = state_->constraints.constraints[constraint_].goal;
  if (auto* point = std::get_if<DistanceToPoint>(&goal)) {
    point->p_in_world = p_in_world;
    return;
  }
  auto* support = std::get_if<Support>(&goal);
  MAREY_ASSERT(support != nullptr);
  support->footprint_in_world = p_in_world;
}

void Adapter::Handle::set_orientation(const glm::dquat& world_from_t_pose) {
  MAREY_ASSERT(is_unit(world_from_t_pose));
  Goal& goal = state_->constraints.constraints[constraint_].goal;
  if (auto* orientation = std::get_if<SegmentOrientation>(&goal)) {
    orientation->world_from_t_pose = world_from_t_pose;
    return;
  }
  auto* support = std::get_if<Support>(&goal);
  MAREY_ASSERT(support != nullptr);
  support->world_from_t_pose = world_from_t_pose;
}

void Adapter::Handle::set_space(const glm::dvec3& min_in_world,
                                const glm::dvec3& max_in_world) {
  MAREY_ASSERT(is_finite(min_in_world) && is_finite(max_in_world));
  MAREY_ASSERT(min_in_world.x <= max_in_world.x && min_in_world.y <= max_in_world.y &&
               min_in_world.z <= max_in_world.z);
  Goal& goal = state_->constraints.constraints[constraint_].goal;
  if (auto* allowed = std::get_if<AllowedSpace>(&goal)) {
    *allowed = {min_in_world, max_in_world};
    return;
  }
  auto* forbidden = std::get_if<ForbiddenSpace>(&goal);
  MAREY_ASSERT(forbidden != nullptr);
  *forbidden = {min_in_world, max_in_world};
}

void Adapter::Handle::set_offset(const glm::dvec3& offset_in_t_pose) {
  MAREY_ASSERT(is_finite(offset_in_t_pose));
  glm::dvec3& offset =
      state_->constraints.constraints[constraint_].point.offset_in_t_pose;
  const bool was_at_joint = offset == glm::dvec3(0.0);
  offset = offset_in_t_pose;
  // A point at the joint itself moves with the bone above, every other point with the
  // joint's own bone.
  if (was_at_joint != (offset == glm::dvec3(0.0))) state_->set_up();
}

void Adapter::Handle::start(double time_s) {
  MAREY_ASSERT(std::isfinite(time_s));
  state_->live[constraint_].start(time_s);
}

void Adapter::Handle::stop(double time_s) {
  MAREY_ASSERT(std::isfinite(time_s));
  state_->live[constraint_].stop(time_s);
}

const ConstraintOutcome& Adapter::Handle::outcome() const {
  return state_->outcomes[constraint_];
}

}  // namespace marey::retarget
