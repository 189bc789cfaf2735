// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/member.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <type_traits>
#include <variant>

#include "core/base/assert.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::retarget {
namespace {

// Blocks are copied byte by byte and never destroyed.
template <class T>
constexpr bool kIsPlain =
    std::is_trivially_copyable_v<T>&& std::is_trivially_destructible_v<T>;
static_assert(kIsPlain<MemberHead> && kIsPlain<MemberTarget> && kIsPlain<MemberMass> &&
              kIsPlain<LiveActivation> && kIsPlain<ConstraintOutcome> &&
              kIsPlain<RigidTransform>);

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

void set_goal(const Constraint& constraint,
              const ConstraintSet& constraints,
              const glm::dquat& other_t_pose,
              MemberTarget& target) {
  TargetNumbers& numbers = target.numbers;
  const Goal& goal = constraint.goal;
  if (const auto* to_point = std::get_if<DistanceToPoint>(&goal)) {
    numbers.a_in_world = to_point->p_in_world;
    numbers.distance_m = to_point->distance_m;
  } else if (const auto* to_body = std::get_if<DistanceToBody>(&goal)) {
    numbers.b = glm::conjugate(other_t_pose) * to_body->other.offset_in_t_pose;
    numbers.distance_m = to_body->distance_m;
  } else if (const auto* to_other = std::get_if<DistanceToConstraint>(&goal)) {
    const Constraint* other = constraints.find(to_other->other_id);
    target.other = static_cast<int>(other - constraints.constraints.data());
    numbers.distance_m = to_other->distance_m;
  } else if (const auto* allowed = std::get_if<AllowedSpace>(&goal)) {
    numbers.a_in_world = allowed->min_in_world;
    numbers.b = allowed->max_in_world;
  } else if (const auto* forbidden = std::get_if<ForbiddenSpace>(&goal)) {
    numbers.a_in_world = forbidden->min_in_world;
    numbers.b = forbidden->max_in_world;
  } else if (const auto* orientation = std::get_if<SegmentOrientation>(&goal)) {
    numbers.world_from_joint = orientation->world_from_t_pose * target.t_pose_from_joint;
  } else {
    const auto& support = std::get<Support>(goal);
    target.is_placed = support.footprint_in_world.has_value();
    target.is_turned = support.world_from_t_pose.has_value();
    target.turns = support.turns;
    if (target.is_placed) numbers.a_in_world = *support.footprint_in_world;
    if (target.is_turned) {
      numbers.world_from_joint = *support.world_from_t_pose * target.t_pose_from_joint;
    }
  }
}

}  // namespace

MemberMemory::MemberMemory(std::size_t bytes)
    : bytes_(static_cast<std::byte*>(
          ::operator new (bytes, std::align_val_t{kMemberAlignment}))) {}

void MemberMemory::Free::operator()(std::byte* bytes) const {
  ::operator delete (bytes, std::align_val_t{kMemberAlignment});
}

void replan_member(const SharedPlan& shared,
                   const Character& character,
                   const Member& member) {
  const BodyNumbers body = body_numbers(character, shared.plan);
  MAREY_ASSERT(body.packed.size() == member.numbers().size());
  std::ranges::copy(body.packed, member.numbers().begin());
  member.head().unit_m = body.unit_m;
  member.head().control = member.head().options.control;
  for (std::size_t i = 0; i < member.carried().size(); ++i) {
    member.carry(i, member.carried()[i] != 0);
  }
  for (ConstraintOutcome& outcome : member.outcomes()) outcome = {};
}

void begin_member(const SharedPlan& shared,
                  const Character& character,
                  const ConstraintSet& constraints,
                  const AdaptOptions& options,
                  const Member& member) {
  const auto start = [](auto array) {
    std::uninitialized_value_construct(array.begin(), array.end());
  };
  ::new (static_cast<void*>(member.block())) MemberHead;
  member.head().options = options;
  start(member.targets());
  start(member.outcomes());
  start(member.world_from_joint());
  start(member.numbers());
  start(member.masses());
  start(member.carried());
  const auto set_mass = [&](std::size_t m, const PointMass& mass) {
    member.masses()[m] = {mass.p_in_joint, mass.mass_kg};
  };
  const std::size_t own = character.masses.size();
  for (std::size_t m = 0; m < own; ++m) set_mass(m, character.masses[m]);
  for (std::size_t i = 0; i < character.loads.size(); ++i) {
    set_mass(own + i, character.loads[i].mass);
  }
  const std::vector<glm::dquat> t_pose = t_pose_rotations(character);
  for (const PointPlan& point : shared.plan.points) {
    const auto c = static_cast<std::size_t>(point.constraint);
    const Constraint& constraint = constraints.constraints[c];
    MemberTarget& target = member.targets()[c];
    target.goal = point.goal;
    target.is_at_joint = constraint.point.offset_in_t_pose == glm::dvec3(0.0);
    target.max_met_error = max_met_error(constraint);
    target.t_pose_from_joint = t_pose[static_cast<std::size_t>(point.joint)];
    target.numbers.in_joint =
        glm::conjugate(target.t_pose_from_joint) * constraint.point.offset_in_t_pose;
    target.numbers.precision_m = constraint.precision_m;
    target.numbers.weight = constraint.importance;
    const int other = point.other_joint >= 0 ? point.other_joint : point.joint;
    set_goal(constraint, constraints, t_pose[static_cast<std::size_t>(other)], target);
    std::construct_at(&member.activations()[c], constraint.activation);
  }
  replan_member(shared, character, member);
}

void Member::carry(std::size_t load, bool carried) const {
  const std::size_t m = layout_->own_masses + load;
  this->carried()[load] = carried ? 1 : 0;
  const std::size_t first = layout_->numbers - 4 * layout_->masses;
  numbers()[first + 4 * m] = static_cast<float>(carried ? masses()[m].mass_kg : 0.0);
}

glm::dvec3 Member::centre_of_mass_in_world(const Plan& plan) const {
  glm::dvec3 moment(0.0);
  double mass_kg = 0.0;
  const auto add = [&](std::size_t m) {
    const MemberMass& mass = masses()[m];
    const auto j = static_cast<std::size_t>(plan.masses[m].joint);
    moment += mass.mass_kg * (world_from_joint()[j] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  };
  for (std::size_t m = 0; m < layout_->own_masses; ++m) add(m);
  for (std::size_t i = 0; i < carried().size(); ++i) {
    if (carried()[i]) add(layout_->own_masses + i);
  }
  return moment / mass_kg;
}

void Member::update_report(const Plan& plan, const float* errors) const {
  AdaptReport& report = head().report;
  report = {};
  double weights = 0.0;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const PointPlan& point = plan.points[k];
    const auto c = static_cast<std::size_t>(point.constraint);
    const MemberTarget& target = targets()[c];
    ConstraintOutcome& outcome = outcomes()[c];
    const auto error = static_cast<double>(errors[k]);
    const bool counts = outcome.activation > kFirmActivation;
    outcome.error_m = 0.0;
    outcome.error_rad = 0.0;
    if (point.turns_only()) {
      // turn_left() returns twice the sine of half the angle.
      outcome.error_rad = 2.0 * std::asin(std::min(1.0, 0.5 * error));
    } else {
      outcome.error_m = error * head().unit_m;
    }
    outcome.met = counts && (point.turns_only() ? outcome.error_rad : outcome.error_m) <=
                                target.max_met_error;
    report.worst_error_m = std::max(report.worst_error_m, outcome.error_m);
    report.worst_error_rad = std::max(report.worst_error_rad, outcome.error_rad);
    if (!counts || point.turns_only() || point.level == 0) continue;
    report.constraint_error_m += target.numbers.weight * outcome.error_m;
    weights += target.numbers.weight;
  }
  if (weights > 0.0) report.constraint_error_m /= weights;
}

void Member::write(const Plan& plan, const float* result, Pose& out) const {
  const std::size_t n = layout_->joints;
  const std::span<RigidTransform> joints = world_from_joint();
  const double unit_m = head().unit_m;
  const glm::dvec3 origin_in_world = head().origin_in_world;
  out.parent_from_joint.resize(n);
  ResultReader from(result);
  for (std::size_t i = 0; i < n; ++i) out.parent_from_joint[i] = from.rotation();
  for (std::size_t i = 0; i < n; ++i) joints[i].rotation = from.rotation();
  for (std::size_t i = 0; i < n; ++i) {
    joints[i].translation = origin_in_world + from.vector() * unit_m;
  }
  update_report(plan, from.here());
  for (std::size_t k = 0; k < plan.points.size(); ++k) from.number();
  AdaptReport& report = head().report;
  report.iterations = static_cast<int>(from.number());
  report.capped = from.number() > 0.0;
  report.balance_error_m = from.number() * unit_m;
  out.root_in_world = joints[0].translation;
}

}  // namespace marey::retarget
