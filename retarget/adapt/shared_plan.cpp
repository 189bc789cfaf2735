// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/shared_plan.h"

#include "retarget/adapt/member_block.h"

namespace marey::retarget {
namespace {

MemberLayout layout_of(const Plan& plan) {
  MemberLayout out;
  out.joints = plan.parent.size();
  out.constraints = plan.points.size();
  out.masses = plan.masses.size();
  out.own_masses = plan.own_masses;
  out.numbers = body_number_count(plan);
  out.bytes = sizeof(MemberHead);
  const auto place = [&](std::size_t count, std::size_t size) {
    constexpr std::size_t kStep = alignof(double);
    const std::size_t at = out.bytes;
    out.bytes += (count * size + kStep - 1) / kStep * kStep;
    return at;
  };
  out.numbers_at = place(out.numbers, sizeof(float));
  out.targets_at = place(out.constraints, sizeof(MemberTarget));
  out.outcomes_at = place(out.constraints, sizeof(ConstraintOutcome));
  out.joints_at = place(out.joints, sizeof(RigidTransform));
  // The rest is rarely read.
  out.activations_at = place(out.constraints, sizeof(LiveActivation));
  out.masses_at = place(out.masses, sizeof(MemberMass));
  out.carried_at = place(out.masses - out.own_masses, sizeof(char));
  out.bytes = (out.bytes + kMemberAlignment - 1) / kMemberAlignment * kMemberAlignment;
  return out;
}

}  // namespace

std::shared_ptr<const SharedPlan> make_shared_plan(const Character& character,
                                                   const ConstraintSet& constraints,
                                                   bool balance) {
  auto out = std::make_shared<SharedPlan>();
  out->plan = make_plan(character, constraints, balance);
  out->thesis = {make_thesis_plan(out->plan), balance};
  out->layout = layout_of(out->plan);
  return out;
}

std::shared_ptr<const AdapterNames> make_names(const Character& character,
                                               const ConstraintSet& constraints) {
  auto out = std::make_shared<AdapterNames>();
  for (const Constraint& c : constraints.constraints) out->constraints.push_back(c.id);
  for (const Load& load : character.loads) out->loads.push_back(load.name);
  return out;
}

}  // namespace marey::retarget
