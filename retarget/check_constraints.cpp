// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/check_constraints.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/humanoid.h"
#include "retarget/check_goal.h"
#include "retarget/check_relations.h"
#include "retarget/constraint_error.h"

namespace marey::retarget {
namespace {

/// Constraints with a later start wait until a caller starts them.
constexpr double kStartedByHand_s = 1e8;

Refusal check_ids(const ConstraintSet& set) {
  std::set<std::string_view> ids;
  int count = 0;
  for (const Constraint& c : set.constraints) {
    ++count;
    if (c.id.empty()) {
      return bad_input("constraint " + std::to_string(count) + ", counted from 1",
                       "it has no id",
                       "give it one that no other has");
    }
    if (!ids.insert(c.id).second) {
      return refused(
          c, "another constraint has this id, too", "give each its own, or remove one");
    }
  }
  return std::nullopt;
}

Refusal check_activation(const Constraint& c) {
  const Activation& a = c.activation;
  for (const auto& [what, time_s] :
       {std::pair("start", a.start_s), std::pair("stop", a.stop_s)}) {
    if (!time_s) continue;
    if (auto wrong = check_number(c, what, *time_s, -kLatest_s, kLatest_s)) return wrong;
  }
  for (const auto& [what, duration_s] : {std::pair("start duration", a.start_duration_s),
                                         std::pair("stop duration", a.stop_duration_s)}) {
    if (auto wrong = check_number(c, what, duration_s, 0.0, kLatest_s)) return wrong;
  }
  if (!a.start_s || !a.stop_s || *a.start_s <= *a.stop_s) return std::nullopt;
  return refused(c,
                 "it stops at " + digits(*a.stop_s) + " s, before it starts at " +
                     digits(*a.start_s) + " s",
                 "exchange the two");
}

Refusal check_one(const Constraint& c,
                  const ConstraintSet& set,
                  const Character& character) {
  if (auto wrong = check_point(c, c.point, character.skeleton)) return wrong;
  constexpr double kLeast = 1e-6;
  constexpr double kMost = 1e6;
  if (auto wrong = check_number(c, "importance", c.importance, kLeast, kMost)) {
    return wrong;
  }
  if (auto wrong = check_number(c, "precision", c.precision_m, 0.0, kFurthest_m)) {
    return wrong;
  }
  if (c.range && *c.range < 1) {
    return refused(c,
                   "its range is " + std::to_string(*c.range),
                   "give 1 for its own segment alone, more for those above it");
  }
  if (auto wrong = check_activation(c)) return wrong;
  return check_goal(c, set, character);
}

/// Checks the number of constraints. A solve costs the cube of it: without a limit a file
/// of some hundred keeps a processor busy for hours.
Refusal check_count(const ConstraintSet& set) {
  const std::size_t count = set.constraints.size();
  if (count > kMaxConstraints) {
    return bad_input("the constraints",
                     "there are " + std::to_string(count) + ", but at most " +
                         std::to_string(kMaxConstraints) + " can be solved",
                     "divide them by time into several files, and the motion with them");
  }
  // Ends come before starts of the same time.
  std::vector<std::pair<double, int>> changes;
  for (const Constraint& c : set.constraints) {
    const Activation& a = c.activation;
    const double start_s = a.start_s.value_or(-kLatest_s);
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
        time_s <= -kLatest_s ? "from the start on" : "at " + digits(time_s) + " s";
    return bad_input("the constraints",
                     "more than " + std::to_string(kMaxActiveConstraints) +
                         " are active " + when + ", the most that one solve can hold",
                     "give some of them other times, or remove some");
  }
  return std::nullopt;
}

Refusal check_all(const ConstraintSet& set, const Character& character) {
  if (auto wrong = check_ids(set)) return wrong;
  for (const Constraint& c : set.constraints) {
    if (auto wrong = check_one(c, set, character)) return wrong;
  }
  if (auto wrong = check_count(set)) return wrong;
  if (auto wrong = check_circles(set)) return wrong;
  return check_contradictions(set, character.skeleton);
}

}  // namespace

std::optional<JointIndex> resolve_segment(const Skeleton& skeleton,
                                          std::string_view name) {
  if (const std::optional<HumanBone> bone = human_bone(name)) {
    if (const std::optional<JointIndex> joint = skeleton.find(*bone)) return joint;
  }
  return skeleton.find(name);
}

Status check_constraints(const ConstraintSet& constraints, const Character& character) {
  if (auto wrong = check_all(constraints, character)) return *wrong;
  return Done{};
}

}  // namespace marey::retarget
