// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/check_relations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "core/base/assert.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::retarget {
namespace {

/// Returns the duration for which both are fully active; 0 or less: never.
double common_s(const Activation& a, const Activation& b) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const auto from = [=](const Activation& c) {
    return c.start_s ? *c.start_s + c.start_duration_s : -kEver;
  };
  const auto until = [=](const Activation& c) { return c.stop_s.value_or(kEver); };
  return std::min(until(a), until(b)) - std::max(from(a), from(b));
}

/// Returns true if there is a time at which both are fully active.
bool hold_at_once(const Activation& a, const Activation& b) {
  return common_s(a, b) > 0.0;
}

bool have_common_point(const AllowedSpace& a, const AllowedSpace& b) {
  return glm::all(glm::lessThanEqual(glm::max(a.min_in_world, b.min_in_world),
                                     glm::min(a.max_in_world, b.max_in_world)));
}

/// Returns true for a constraint with such a late start that a caller starts and places
/// it.
bool is_for_callers(const Constraint& c) {
  return c.activation.start_s.value_or(0.0) >= kCallerStart_s;
}

/// Returns the distance of `p` from the nearest point of a box; 0 inside.
double outside_m(const glm::dvec3& p, const AllowedSpace& box) {
  return glm::distance(p, glm::clamp(p, box.min_in_world, box.max_in_world));
}

/// Returns the distance of `p` from the nearest point outside a box; 0 or less outside.
double inside_m(const glm::dvec3& p, const ForbiddenSpace& box) {
  const glm::dvec3 depth = glm::min(p - box.min_in_world, box.max_in_world - p);
  return std::min({depth.x, depth.y, depth.z});
}

/// Returns the sum of both tolerances.
double slack_m(const Constraint& a, const Constraint& b) {
  constexpr double kRounding_m = 1e-9;
  return a.precision_m + b.precision_m + kRounding_m;
}

/// Formats a length in metres with three decimals.
std::string metres(double length_m) {
  return digits(std::round(length_m * 1e3) * 1e-3) + " m";
}

/// The faces of a forbidden box are permitted.
bool lies_inside(const AllowedSpace& allowed, const ForbiddenSpace& forbidden) {
  return glm::all(glm::greaterThan(allowed.min_in_world, forbidden.min_in_world)) &&
         glm::all(glm::lessThan(allowed.max_in_world, forbidden.max_in_world));
}

/// Returns the reason why a footprint and a box of the same point are incompatible; empty
/// if compatible.
std::string_view contradicts_footprint(const Constraint& stands, const Constraint& box) {
  const auto& footprint = std::get<Support>(stands.goal).footprint_in_world;
  if (!footprint || is_for_callers(stands)) return "";
  if (const auto* allowed = std::get_if<AllowedSpace>(&box.goal)) {
    if (outside_m(*footprint, *allowed) > slack_m(stands, box)) {
      return "its footprint lies outside the other's allowed box";
    }
  }
  if (const auto* forbidden = std::get_if<ForbiddenSpace>(&box.goal)) {
    if (inside_m(*footprint, *forbidden) > slack_m(stands, box)) {
      return "its footprint lies inside the other's forbidden box";
    }
  }
  return "";
}

/// Returns the reason why two targets of one point are incompatible; empty if compatible.
std::string_view contradiction(const Constraint& first, const Constraint& second) {
  if (const auto* a = std::get_if<AllowedSpace>(&first.goal)) {
    const auto* b = std::get_if<AllowedSpace>(&second.goal);
    if (b != nullptr && !have_common_point(*a, *b)) {
      return "their allowed boxes have no point in common";
    }
    const auto* forbidden = std::get_if<ForbiddenSpace>(&second.goal);
    if (forbidden != nullptr && lies_inside(*a, *forbidden)) {
      return "its allowed box lies inside the other's forbidden one";
    }
  }
  const auto* a = std::get_if<Support>(&first.goal);
  if (a == nullptr) return "";
  const auto* b = std::get_if<Support>(&second.goal);
  if (b == nullptr) return contradicts_footprint(first, second);
  if (a->footprint_in_world && b->footprint_in_world &&
      *a->footprint_in_world != *b->footprint_in_world) {
    return "a foot cannot stand on two footprints";
  }
  return "";
}

constexpr const char* kChangeOne =
    "change one of them, or let one stop before the other starts";

/// The distance between two points of one foot is constant. At a direct transition both
/// may hold for a moment, also on a moving floor.
OptionalError check_foot(const Constraint& a, const Constraint& b) {
  constexpr double kTakingOver_s = 0.01;
  if (common_s(a.activation, b.activation) <= kTakingOver_s) return std::nullopt;
  const auto* one = std::get_if<Support>(&a.goal);
  const auto* other = std::get_if<Support>(&b.goal);
  if (one == nullptr || other == nullptr || !one->footprint_in_world ||
      !other->footprint_in_world || is_for_callers(a) || is_for_callers(b)) {
    return std::nullopt;
  }
  const double points_m =
      glm::distance(a.point.offset_in_t_pose, b.point.offset_in_t_pose);
  const double prints_m =
      glm::distance(*one->footprint_in_world, *other->footprint_in_world);
  if (std::abs(points_m - prints_m) <= slack_m(a, b)) return std::nullopt;
  return constraint_error(
      a,
      "it contradicts \"" + b.id + "\" on the same foot: their points are " +
          metres(points_m) + " apart and their footprints " + metres(prints_m),
      kChangeOne);
}

bool may_contradict(const Goal& goal) {
  return std::holds_alternative<AllowedSpace>(goal) ||
         std::holds_alternative<ForbiddenSpace>(goal) ||
         std::holds_alternative<Support>(goal);
}

std::string cycle_text(const ConstraintSet& set, const std::vector<std::size_t>& cycle) {
  constexpr std::size_t kMax = 8;  // Limit of names in one message.
  std::string text;
  for (std::size_t i = 0; i < std::min(cycle.size(), kMax); ++i) {
    text += "\"" + set.constraints[cycle[i]].id + "\" to ";
  }
  if (cycle.size() > kMax) text += "others, then to ";
  return text + "\"" + set.constraints[cycle.front()].id + "\"";
}

OptionalError check_places(const ConstraintSet& set, const Skeleton& skeleton) {
  std::vector<std::pair<const Constraint*, JointIndex>> known;
  for (const Constraint& c : set.constraints) {
    if (!may_contradict(c.goal)) continue;
    const auto joint = resolve_segment(skeleton, c.point.segment);
    MAREY_ASSERT(joint.has_value());
    for (const auto& [earlier, its_joint] : known) {
      if (its_joint != *joint || !hold_at_once(earlier->activation, c.activation)) {
        continue;
      }
      if (earlier->point.offset_in_t_pose != c.point.offset_in_t_pose) {
        if (auto wrong = check_foot(c, *earlier)) return wrong;
        continue;
      }
      for (const auto& [a, b] : {std::pair(&c, earlier), std::pair(earlier, &c)}) {
        const std::string_view why = contradiction(*a, *b);
        if (why.empty()) continue;
        return constraint_error(
            *a,
            "it contradicts \"" + b->id + "\" on the same point: " + std::string(why),
            kChangeOne);
      }
    }
    known.emplace_back(&c, *joint);
  }
  return std::nullopt;
}

/// A distance between two points of the body, and the constraint that keeps it.
struct KeptDistance {
  const Constraint* constraint;
  double distance_m;
  JointIndex joints[2];
  glm::dvec3 offsets[2];
};

bool is_between_the_same(const KeptDistance& a, const KeptDistance& b) {
  const auto same = [&](int i, int j) {
    return a.joints[i] == b.joints[j] && a.offsets[i] == b.offsets[j];
  };
  return (same(0, 0) && same(1, 1)) || (same(0, 1) && same(1, 0));
}

OptionalError check_distances(const ConstraintSet& set, const Skeleton& skeleton) {
  std::vector<KeptDistance> known;
  for (const Constraint& c : set.constraints) {
    const BodyPoint* other = nullptr;
    double distance_m = 0.0;
    if (const auto* body = std::get_if<DistanceToBody>(&c.goal)) {
      other = &body->other;
      distance_m = body->distance_m;
    } else if (const auto* to = std::get_if<DistanceToConstraint>(&c.goal)) {
      other = &set.find(to->other_id)->point;
      distance_m = to->distance_m;
    } else {
      continue;
    }
    const auto own_joint = resolve_segment(skeleton, c.point.segment);
    const auto other_joint = resolve_segment(skeleton, other->segment);
    MAREY_ASSERT(own_joint.has_value() && other_joint.has_value());
    const KeptDistance kept{&c,
                            distance_m,
                            {*own_joint, *other_joint},
                            {c.point.offset_in_t_pose, other->offset_in_t_pose}};
    for (const KeptDistance& earlier : known) {
      const Constraint& e = *earlier.constraint;
      if (!is_between_the_same(kept, earlier) ||
          !hold_at_once(c.activation, e.activation) ||
          std::abs(distance_m - earlier.distance_m) <= slack_m(c, e)) {
        continue;
      }
      return constraint_error(c,
                              "it contradicts \"" + e.id +
                                  "\" on the same two points: it keeps " +
                                  metres(distance_m) + " between them and the other " +
                                  metres(earlier.distance_m),
                              kChangeOne);
    }
    known.push_back(kept);
  }
  return std::nullopt;
}

}  // namespace

OptionalError check_cycles(const ConstraintSet& set) {
  std::map<std::string_view, std::size_t> place;
  for (std::size_t i = 0; i < set.constraints.size(); ++i) {
    place.emplace(set.constraints[i].id, i);
  }
  // Each constraint names at most one other. A walk that reaches itself has found a
  // cycle; constraints that an earlier walk reached are in no cycle.
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
      return constraint_error(
          set.constraints[at],
          "the distances form a cycle: " + cycle_text(set, path),
          "let one of them keep its distance from a point of the body");
    }
  }
  return std::nullopt;
}

OptionalError check_contradictions(const ConstraintSet& set, const Skeleton& skeleton) {
  if (auto wrong = check_places(set, skeleton)) return wrong;
  return check_distances(set, skeleton);
}

}  // namespace marey::retarget
