// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "retarget/adapt/kernel/thesis_solve.h"
#include "retarget/adapt/plan/adapt_plan.h"

namespace marey::retarget {

/// Counts and byte offsets of the arrays of a member's block (member.h). Equal for bodies
/// with equal plans.
struct MemberLayout {
  std::size_t joints = 0;
  std::size_t constraints = 0;
  std::size_t masses = 0;  ///< Masses of the body, then its loads.
  std::size_t own_masses = 0;
  std::size_t numbers = 0;  ///< Packed constants of the body.

  std::size_t numbers_at = 0;
  std::size_t targets_at = 0;
  std::size_t activations_at = 0;
  std::size_t outcomes_at = 0;
  std::size_t masses_at = 0;
  std::size_t joints_at = 0;
  std::size_t carried_at = 0;
  std::size_t bytes = 0;  ///< A multiple of kMemberAlignment.
};

inline constexpr std::size_t kMemberAlignment = 64;

/// Everything that depends on the structure of a body and its constraints alone. All
/// members of a crowd use one instance.
struct SharedPlan {
  Plan plan;
  ThesisShape thesis;
  MemberLayout layout;
};

/// Makes the plan of a character. Precondition: as make_plan().
[[nodiscard]] std::shared_ptr<const SharedPlan> make_shared_plan(
    const Character& character, const ConstraintSet& constraints, bool balance);

/// Names by which a user addresses parts of an adapter. Members of a crowd with equal
/// names use one instance.
struct AdapterNames {
  std::vector<std::string> constraints;  ///< Ids, in the order of the constraint set.
  std::vector<std::string> loads;
  bool operator==(const AdapterNames&) const = default;
};

[[nodiscard]] std::shared_ptr<const AdapterNames> make_names(
    const Character& character, const ConstraintSet& constraints);

}  // namespace marey::retarget
