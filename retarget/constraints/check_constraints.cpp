// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/check_constraints.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "retarget/constraints/check_goal.h"
#include "retarget/constraints/check_relations.h"
#include "retarget/constraints/constraint_error.h"

namespace marey::retarget {
namespace {

/// Constraints with a later start are started by a caller.
constexpr double kStartedByHand_s = 1e8;

OptionalError check_ids(const ConstraintSet& set) {
  std::set<std::string_view> ids;
  int count = 0;
  for (const Constraint& c : set.constraints) {
    ++count;
    if (c.id.empty()) {
      return bad_input("constraint " + std::to_string(count) + ", counted from 1",
                       "it has no id",
                       "give it a unique id");
    }
    if (!ids.insert(c.id).second) {
      return constraint_error(
          c, "another constraint has the same id", "rename or remove one");
    }
  }
  return std::nullopt;
}

OptionalError check_activation(const Constraint& c) {
  const Activation& a = c.activation;
  for (const auto& [what, time_s] :
       {std::pair("start", a.start_s), std::pair("stop", a.stop_s)}) {
    if (!time_s) continue;
    if (auto wrong = check_number(c, what, *time_s, -kMaxTime_s, kMaxTime_s))
      return wrong;
  }
  for (const auto& [what, duration_s] : {std::pair("start duration", a.start_duration_s),
                                         std::pair("stop duration", a.stop_duration_s)}) {
    if (auto wrong = check_number(c, what, duration_s, 0.0, kMaxTime_s)) return wrong;
  }
  if (!a.start_s || !a.stop_s || *a.start_s <= *a.stop_s) return std::nullopt;
  return constraint_error(c,
                          "it stops at " + digits(*a.stop_s) +
                              " s, before it starts at " + digits(*a.start_s) + " s",
                          "exchange the two");
}

OptionalError check_one(const Constraint& c,
                        const ConstraintSet& set,
                        const Character& character) {
  if (auto wrong = check_point(c, c.point, character.skeleton)) return wrong;
  constexpr double kMin = 1e-6;
  constexpr double kMax = 1e6;
  if (auto wrong = check_number(c, "importance", c.importance, kMin, kMax)) {
    return wrong;
  }
  if (auto wrong = check_number(c, "precision", c.precision_m, 0.0, kMaxLength_m)) {
    return wrong;
  }
  if (c.range && *c.range < 1) {
    return constraint_error(
        c,
        "its range is " + std::to_string(*c.range),
        "use 1 for its own segment, or more to include segments above it");
  }
  if (auto wrong = check_activation(c)) return wrong;
  return check_goal(c, set, character);
}

/// Checks the number of constraints. The cost of a solve is cubic in it: without a limit,
/// a file with some hundred constraints would take hours.
OptionalError check_count(const ConstraintSet& set) {
  const std::size_t count = set.constraints.size();
  if (count > kMaxConstraints) {
    return bad_input("the constraints",
                     "there are " + std::to_string(count) + ", but at most " +
                         std::to_string(kMaxConstraints) + " can be solved",
                     "split the constraints and the motion by time into several files");
  }
  // At equal times ends come before starts.
  std::vector<std::pair<double, int>> changes;
  for (const Constraint& c : set.constraints) {
    const Activation& a = c.activation;
    const double start_s = a.start_s.value_or(-kMaxTime_s);
    if (start_s >= kStartedByHand_s) continue;
    changes.emplace_back(start_s, 1);
    if (a.stop_s) changes.emplace_back(*a.stop_s + a.stop_duration_s, -1);
  }
  std::ranges::sort(changes);
  int active = 0;
  for (const auto& [time_s, change] : changes) {
    active += change;
    if (active <= kMaxActiveConstraints) continue;
    const std::string when =
        time_s <= -kMaxTime_s ? "from the start on" : "at " + digits(time_s) + " s";
    return bad_input("the constraints",
                     "more than " + std::to_string(kMaxActiveConstraints) +
                         " are active " + when + ", the maximum per solve",
                     "change the times of some, or remove some");
  }
  return std::nullopt;
}

OptionalError check_all(const ConstraintSet& set, const Character& character) {
  if (auto wrong = check_ids(set)) return wrong;
  for (const Constraint& c : set.constraints) {
    if (auto wrong = check_one(c, set, character)) return wrong;
  }
  if (auto wrong = check_count(set)) return wrong;
  if (auto wrong = check_cycles(set)) return wrong;
  return check_contradictions(set, character.skeleton);
}

}  // namespace

Status check_constraints(const ConstraintSet& constraints, const Character& character) {
  if (auto wrong = check_all(constraints, character)) return *wrong;
  return Done{};
}

}  // namespace marey::retarget
