// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/check_relations.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vector_relational.hpp>

#include "core/assert.h"
#include "retarget/check_constraints.h"

namespace marey::retarget {
namespace {

/// Whether there is a moment at which both are fully active.
bool hold_at_once(const Activation& a, const Activation& b) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const auto from = [=](const Activation& c) {
    return c.start_s ? *c.start_s + c.start_duration_s : -kEver;
  };
  const auto until = [=](const Activation& c) { return c.stop_s.value_or(kEver); };
  return std::max(from(a), from(b)) < std::min(until(a), until(b));
}

bool have_common_point(const AllowedSpace& a, const AllowedSpace& b) {
  return glm::all(glm::lessThanEqual(glm::max(a.min_in_world, b.min_in_world),
                                     glm::min(a.max_in_world, b.max_in_world)));
}

/// The faces of a forbidden box are not forbidden.
bool lies_inside(const AllowedSpace& allowed, const ForbiddenSpace& forbidden) {
  return glm::all(glm::greaterThan(allowed.min_in_world, forbidden.min_in_world)) &&
         glm::all(glm::lessThan(allowed.max_in_world, forbidden.max_in_world));
}

/// Why two goals of one point cannot both be met; empty when they may.
std::string_view contradiction(const Goal& first, const Goal& second) {
  if (const auto* a = std::get_if<AllowedSpace>(&first)) {
    const auto* b = std::get_if<AllowedSpace>(&second);
    if (b != nullptr && !have_common_point(*a, *b)) {
      return "their allowed boxes have no point in common";
    }
    const auto* forbidden = std::get_if<ForbiddenSpace>(&second);
    if (forbidden != nullptr && lies_inside(*a, *forbidden)) {
      return "its allowed box lies inside the other's forbidden one";
    }
  }
  const auto* a = std::get_if<Support>(&first);
  const auto* b = std::get_if<Support>(&second);
  if (a != nullptr && b != nullptr && a->footprint_in_world && b->footprint_in_world &&
      *a->footprint_in_world != *b->footprint_in_world) {
    return "a foot cannot stand on two footprints";
  }
  return "";
}

bool may_contradict(const Goal& goal) {
  return std::holds_alternative<AllowedSpace>(goal) ||
         std::holds_alternative<ForbiddenSpace>(goal) ||
         std::holds_alternative<Support>(goal);
}

std::string circle_text(const ConstraintSet& set,
                        const std::vector<std::size_t>& circle) {
  constexpr std::size_t kMost = 8;  // A message stays on its line.
  std::string text;
  for (std::size_t i = 0; i < std::min(circle.size(), kMost); ++i) {
    text += "\"" + set.constraints[circle[i]].id + "\" to ";
  }
  if (circle.size() > kMost) text += "others, at last to ";
  return text + "\"" + set.constraints[circle.front()].id + "\"";
}

}  // namespace

Refusal check_circles(const ConstraintSet& set) {
  std::map<std::string_view, std::size_t> place;
  for (std::size_t i = 0; i < set.constraints.size(); ++i) {
    place.emplace(set.constraints[i].id, i);
  }
  // Each leads to one other at most. A walk that meets itself has found a circle; what an
  // earlier walk has seen leads to none.
  std::vector<std::size_t> walk_that_saw(set.constraints.size(), 0);
  for (std::size_t walk = 1; walk <= set.constraints.size(); ++walk) {
    std::vector<std::size_t> path;
    for (std::size_t at = walk - 1; walk_that_saw[at] == 0;) {
      walk_that_saw[at] = walk;
      path.push_back(at);
      const auto* goal = std::get_if<DistanceToConstraint>(&set.constraints[at].goal);
      if (goal == nullptr) break;
      const auto found = place.find(goal->other_id);
      MAREY_ASSERT(found != place.end());
      at = found->second;
      if (walk_that_saw[at] != walk) continue;
      path.erase(path.begin(), std::find(path.begin(), path.end(), at));
      return refused(set.constraints[at],
                     "distances are kept in a circle: " + circle_text(set, path),
                     "let one of them keep its distance from a point of the body");
    }
  }
  return std::nullopt;
}

Refusal check_contradictions(const ConstraintSet& set, const Skeleton& skeleton) {
  std::vector<std::pair<const Constraint*, JointIndex>> known;
  for (const Constraint& c : set.constraints) {
    if (!may_contradict(c.goal)) continue;
    const auto joint = resolve_segment(skeleton, c.point.segment);
    MAREY_ASSERT(joint.has_value());
    for (const auto& [earlier, its_joint] : known) {
      if (its_joint != *joint ||
          earlier->point.offset_in_t_pose != c.point.offset_in_t_pose ||
          !hold_at_once(earlier->activation, c.activation)) {
        continue;
      }
      for (const auto& [a, b] : {std::pair(&c, earlier), std::pair(earlier, &c)}) {
        const std::string_view why = contradiction(a->goal, b->goal);
        if (why.empty()) continue;
        return refused(
            *a,
            "it contradicts \"" + b->id + "\" on the same point: " + std::string(why),
            "change one of them, or let one stop before the other starts");
      }
    }
    known.emplace_back(&c, *joint);
  }
  return std::nullopt;
}

}  // namespace marey::retarget
