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
  const std::vector<std::string>& ids = state_->names->constraints;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == id) return Handle(*state_, i);
  }
  return std::nullopt;
}

void Adapter::set_balance_target(const std::optional<glm::dvec3>& com_in_world) {
  MAREY_ASSERT(!com_in_world || is_finite(*com_in_world));
  state_->member.head().com_in_world = com_in_world;
}

bool Adapter::carry(std::string_view load, bool carried) {
  const std::vector<std::string>& loads = state_->names->loads;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i] != load) continue;
    state_->member.carry(i, carried);
    return true;
  }
  return false;
}

void Adapter::set_options(const AdaptOptions& options) {
  MAREY_ASSERT(check_options(options).has_value());
  MAREY_ASSERT(!state_->is_member());
  MemberHead& head = state_->member.head();
  head.paused_balance = BalanceMode::kOff;
  const bool replan = (options.balance == BalanceMode::kOff) !=
                      (head.options.balance == BalanceMode::kOff);
  state_->turn_passage(options);
  head.options = options;
  head.control = options.control;
  if (replan) state_->replan();
}

void Adapter::use_balance(bool balance) {
  MemberHead& head = state_->member.head();
  if ((head.options.balance != BalanceMode::kOff) == balance) return;
  const BalanceMode other = head.paused_balance;
  MAREY_ASSERT(!balance || other != BalanceMode::kOff);
  head.paused_balance = head.options.balance;
  head.options.balance = other;
}

AdaptReport Adapter::adapt(const Pose& reference, double time_s, Pose& out) {
  return state_->adapt(reference, time_s, out);
}

std::span<const RigidTransform> Adapter::world_from_joint() const {
  return state_->member.world_from_joint();
}

glm::dvec3 Adapter::centre_of_mass_in_world() const {
  return state_->member.centre_of_mass_in_world(state_->shared->plan);
}

void Adapter::Handle::set_target(const glm::dvec3& p_in_world) {
  MAREY_ASSERT(is_finite(p_in_world));
  MemberTarget& target = state_->member.targets()[constraint_];
  const bool is_support = target.goal == GoalKind::kSupport;
  MAREY_ASSERT(is_support || target.goal == GoalKind::kDistanceToPoint);
  target.numbers.a_in_world = p_in_world;
  if (is_support) target.is_placed = true;
}

void Adapter::Handle::set_orientation(const glm::dquat& world_from_t_pose) {
  MAREY_ASSERT(is_unit(world_from_t_pose));
  MemberTarget& target = state_->member.targets()[constraint_];
  const bool is_support = target.goal == GoalKind::kSupport;
  MAREY_ASSERT(is_support || target.goal == GoalKind::kOrientation);
  target.numbers.world_from_joint = world_from_t_pose * target.t_pose_from_joint;
  if (is_support) target.is_turned = true;
}

void Adapter::Handle::set_space(const glm::dvec3& min_in_world,
                                const glm::dvec3& max_in_world) {
  MAREY_ASSERT(is_finite(min_in_world) && is_finite(max_in_world));
  MAREY_ASSERT(min_in_world.x <= max_in_world.x && min_in_world.y <= max_in_world.y &&
               min_in_world.z <= max_in_world.z);
  MemberTarget& target = state_->member.targets()[constraint_];
  MAREY_ASSERT(target.goal == GoalKind::kAllowedSpace ||
               target.goal == GoalKind::kForbiddenSpace);
  target.numbers.a_in_world = min_in_world;
  target.numbers.b = max_in_world;
}

void Adapter::Handle::set_offset(const glm::dvec3& offset_in_t_pose) {
  MAREY_ASSERT(is_finite(offset_in_t_pose));
  MemberTarget& target = state_->member.targets()[constraint_];
  const bool was_at_joint = target.is_at_joint;
  target.is_at_joint = offset_in_t_pose == glm::dvec3(0.0);
  target.numbers.in_joint = glm::conjugate(target.t_pose_from_joint) * offset_in_t_pose;
  if (AdapterOwn* own = state_->own.get()) {
    own->constraints.constraints[constraint_].point.offset_in_t_pose = offset_in_t_pose;
  }
  // A point at the joint itself moves with the bone above, every other point with the
  // joint's own bone.
  if (was_at_joint != target.is_at_joint) state_->replan();
}

void Adapter::Handle::start(double time_s) {
  MAREY_ASSERT(std::isfinite(time_s));
  state_->member.activations()[constraint_].start(time_s);
}

void Adapter::Handle::stop(double time_s) {
  MAREY_ASSERT(std::isfinite(time_s));
  state_->member.activations()[constraint_].stop(time_s);
}

void Adapter::Handle::set_share(double share) {
  MAREY_ASSERT(share >= 0.0 && share <= 1.0);
  state_->member.activations()[constraint_].set_share(share);
}

const ConstraintOutcome& Adapter::Handle::outcome() const {
  return state_->member.outcomes()[constraint_];
}

}  // namespace marey::retarget
